# SPDX-License-Identifier: Apache-2.0
# zonepack_texts(HEADER NAMESPACE NAME FILE [NAME FILE...]): the generated HEADER holds each FILE of the calling folder as
# the constant NAME in NAMESPACE. Written when CMake runs, which a changed FILE causes, and only when it differs.

function(zonepack_texts header namespace)
  set(text "// Generated.\n#pragma once\n#include <string_view>\nnamespace ${namespace} {\n")
  while(ARGN)
    list(POP_FRONT ARGN name file)
    set(file ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    file(READ ${file} content)
    string(APPEND text "inline constexpr std::string_view ${name} = R\"zonepack(${content})zonepack\";\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endwhile()
  string(APPEND text "}  // namespace ${namespace}\n")
  set(out ${PROJECT_BINARY_DIR}/generated/${header})
  set(before "")
  if(EXISTS ${out})
    file(READ ${out} before)
  endif()
  if(NOT before STREQUAL text)
    file(WRITE ${out} "${text}")
  endif()
endfunction()
