# SPDX-License-Identifier: Apache-2.0
# What buses, lines and cameras of a kernel must hold; each says so where the kernel has none, and is run on the virtual robot.
function(zonepack_device_contract source library)
  zonepack_test_program(${source} zonepack_test_support ${library} GTest::gtest GTest::gtest_main)
  get_filename_component(name ${source} NAME_WE)
  add_test(NAME system/${name} COMMAND ${name})
  set_tests_properties(system/${name} PROPERTIES SKIP_REGULAR_EXPRESSION "NOT TESTED")
endfunction()

zonepack_device_contract(can/can_bus_contract.cpp zonepack_platform)
zonepack_device_contract(gpio/gpio_line_contract.cpp zonepack_gpio)
zonepack_device_contract(camera/video_device_contract.cpp zonepack_platform)
