# SPDX-License-Identifier: Apache-2.0
# zonepack_commit(TARGET HEADER): HEADER defines ZONEPACK_COMMIT, looked up at every build and written only when it
# changed, so that a build with nothing to do stays one.
# As a script: cmake -DSOURCE=DIR -DHEADER=FILE -P zonepack_commit.cmake

function(zonepack_commit target header)
  set(out ${PROJECT_BINARY_DIR}/generated/${header})
  add_custom_target(${target}_commit BYPRODUCTS ${out}
                    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DHEADER=${out}
                            -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
                    COMMENT "Looking up the commit" VERBATIM)
  add_dependencies(${target} ${target}_commit)
endfunction()

if(NOT CMAKE_SCRIPT_MODE_FILE)
  return()
endif()

# Empty where it fails: no git, or no checkout.
function(ask_git result)
  execute_process(COMMAND git -C ${SOURCE} ${ARGN} OUTPUT_VARIABLE answer ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    set(answer "")
  endif()
  set(${result} "${answer}" PARENT_SCOPE)
endfunction()

set(commit unknown)
ask_git(top rev-parse --show-toplevel)
file(REAL_PATH ${SOURCE} here)
if(top STREQUAL here)  # sources unpacked inside of another project's checkout are not that project's commit
  ask_git(full rev-parse HEAD)
  ask_git(changes status --porcelain --untracked-files=no)
  if(full)
    string(SUBSTRING ${full} 0 12 commit)  # a fixed length: git's own depends on how many objects a clone has
    if(changes)
      string(APPEND commit -dirty)
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "// Generated.\n#define ZONEPACK_COMMIT \"${commit}\"\n" @ONLY)
