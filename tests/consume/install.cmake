# Installs the package of a build folder and moves it: cmake -DBUILD= -DSOURCE= -DPREFIX= -P install.cmake. Whatever
# still points to where it was installed, or into the sources, is an error.
set(before ${PREFIX}-before)
file(REMOVE_RECURSE ${PREFIX} ${before})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${before} --component development
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${before} ${PREFIX})

file(GLOB_RECURSE files ${PREFIX}/*.cmake ${PREFIX}/*.pc ${PREFIX}/*.h ${PREFIX}/*.hpp ${PREFIX}/*.glsl)
if(NOT files)
  message(FATAL_ERROR "nothing was installed")
endif()
foreach(file ${files})
  file(READ ${file} text)
  foreach(folder ${SOURCE} ${BUILD} ${before})
    string(FIND "${text}" ${folder} place)
    if(place GREATER_EQUAL 0)
      message(FATAL_ERROR "${file} names ${folder}: the package cannot be moved")
    endif()
  endforeach()
endforeach()
