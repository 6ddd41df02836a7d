# SPDX-License-Identifier: Apache-2.0
# Tests of whole programs and of the repository itself.

add_test(NAME system/include_arrows
         COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/include_arrows_test.py ${PROJECT_SOURCE_DIR})
if(TARGET zonepack AND TARGET zoned)
  add_test(NAME system/run
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/run_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  if(TARGET zonectl)
    add_test(NAME system/map_change
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/map_change_test.sh
                     ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_SOURCE_DIR})
    add_test(NAME system/update_live
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/update_live_test.sh
                     ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_SOURCE_DIR})
    set_tests_properties(system/map_change system/update_live PROPERTIES TIMEOUT 600)
  endif()
  add_test(NAME system/can_utils
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/can_utils_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/recording
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/recording_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/learn
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/learn_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/replay
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/replay_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/evaluate
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/evaluate/evaluate_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/report
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/report_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/report_pages
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/report/pages_test.py
                   ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_SOURCE_DIR})
  set_tests_properties(system/report_pages PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600)
endif()
if(TARGET zonepack AND TARGET zoned AND TARGET zonectl AND TARGET zoneloc)
  add_test(NAME system/runtime_hints
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/runtime_hints_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/documents
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/documents_test.py ${PROJECT_SOURCE_DIR}
                   ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
endif()
add_test(NAME system/packages_listed
         COMMAND ${CMAKE_CURRENT_LIST_DIR}/packages_listed_test.sh ${PROJECT_SOURCE_DIR})
if(TARGET zonepack AND TARGET zoned AND TARGET zonectl AND TARGET zoneloc)
  add_test(NAME system/localizer_run
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/localize/run_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  zonepack_test_program(localize/double_image.cpp zonepack_localizer)
  add_test(NAME system/localizer_replay
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/localize/replay_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR} $<TARGET_FILE:double_image>)
  set_tests_properties(system/localizer_replay PROPERTIES TIMEOUT 600)
  add_test(NAME system/localizer_lost
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/localize/lost_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/localizer_check
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/localize/check_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  set_tests_properties(system/localizer_check PROPERTIES TIMEOUT 1800)
  add_test(NAME system/version
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/version_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR} ${PROJECT_VERSION})
  add_test(NAME system/pages
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/pages_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_SOURCE_DIR})
endif()
if(TARGET zonepack)
  add_test(NAME system/install_and_find_package
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/install_test.sh ${PROJECT_BINARY_DIR}
                   ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests/data)
endif()
if(TARGET zoned)
  add_test(NAME system/runtime_without_packer
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/runtime_alone_test.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR})
endif()

# Packs and manifests as others see them: builds that are killed, and files read without our code.
if(TARGET zonepack)
  add_test(NAME system/killed_build
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/killed_build_test.sh $<TARGET_FILE:zonepack>
                   ${PROJECT_SOURCE_DIR}/tests/data)
  add_test(NAME system/killed_update
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/killed_update_test.sh $<TARGET_FILE:zonepack>
                   ${PROJECT_SOURCE_DIR}/tests/data)
  set_tests_properties(system/killed_build system/killed_update PROPERTIES TIMEOUT 900)
endif()
add_test(NAME system/read_by_hand
         COMMAND ${CMAKE_CURRENT_LIST_DIR}/read_by_hand_test.sh ${PROJECT_SOURCE_DIR})

# Our DBC reader against another one, where that is installed.
zonepack_test_program(dbc/decode_dbc.cpp zonepack_runtime)
file(GLOB dbc_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/config/*.dbc)
add_test(NAME system/dbc_other_reader
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/dbc/other_reader_test.py
                 $<TARGET_FILE:decode_dbc> ${dbc_files})
set_tests_properties(system/dbc_other_reader PROPERTIES SKIP_RETURN_CODE 77)

# zonectl against a run that is made up.
if(TARGET zonectl)
  zonepack_test_program(serve/made_up_run.cpp zonepack_test_support zonepack_runtime)
  if(TARGET zonepack)
    add_test(NAME system/console
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/serve/console_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                     ${PROJECT_SOURCE_DIR})
    add_test(NAME system/ending
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/serve/ending_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                     ${PROJECT_SOURCE_DIR})
  endif()
  add_test(NAME system/zonectl
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/serve/zonectl_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
endif()
