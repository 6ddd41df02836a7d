# SPDX-License-Identifier: Apache-2.0
# zonepack_schemas(TARGET DIR): C++ headers of every .fbs below DIR, as "runtime/DIR/NAME_generated.h".

find_program(FLATC flatc REQUIRED)

function(zonepack_schemas target dir)
  file(GLOB schemas CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${dir}/*.fbs)
  file(RELATIVE_PATH here ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${dir})
  set(out ${PROJECT_BINARY_DIR}/generated/${here})
  set(headers)
  foreach(schema ${schemas})
    get_filename_component(name ${schema} NAME_WE)
    add_custom_command(OUTPUT ${out}/${name}_generated.h
                       COMMAND ${FLATC} --cpp --cpp-std c++17 --scoped-enums -o ${out} ${schema}
                       DEPENDS ${schema} VERBATIM)
    list(APPEND headers ${out}/${name}_generated.h)
  endforeach()
  target_sources(${target} PRIVATE ${headers})
  # Others include these headers too: they must exist before anything that links the target compiles.
  add_custom_target(${target}_schemas DEPENDS ${headers})
  add_dependencies(${target} ${target}_schemas)
endfunction()
