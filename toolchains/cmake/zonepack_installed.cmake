# SPDX-License-Identifier: Apache-2.0
# Run by cmake --install, with the prefix that it was given: makes installed files name each other where they are.

# Headers include each other from the root of the source tree; installed, that root is include/zonepack, and only
# include is on a program's path.
function(zonepack_mend_headers folder)
  file(GLOB entries "${folder}/*")
  foreach(entry ${entries})
    if(IS_DIRECTORY "${entry}")
      zonepack_mend_headers("${entry}")
      continue()
    endif()
    file(READ "${entry}" text)
    set(mended "${text}")
    foreach(root platform runtime packer)
      string(REPLACE "#include \"${root}/" "#include \"zonepack/${root}/" mended "${mended}")
    endforeach()
    if(NOT mended STREQUAL text)
      file(WRITE "${entry}" "${mended}")
    endif()
  endforeach()
endfunction()

# The unit starts the programs of its own prefix.
function(zonepack_mend_unit unit prefix)
  file(READ "${unit}" text)
  string(REPLACE "/usr/bin/" "${prefix}/bin/" text "${text}")
  string(REPLACE "file:///usr/share/" "file://${prefix}/share/" text "${text}")
  file(WRITE "${unit}" "${text}")
endfunction()
