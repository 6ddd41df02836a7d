# SPDX-License-Identifier: Apache-2.0
# A killed zoned, its readers and its successor under a memory limit.
zonepack_test_program(arena_crash_proof.cpp zonepack_test_support zonepack_core)
add_test(NAME system/arena_after_a_crash COMMAND arena_crash_proof)
set_tests_properties(system/arena_after_a_crash PROPERTIES SKIP_RETURN_CODE 77)
