# Headers of the build machine that do for every machine. Where its other headers do not, as under Debian, they are put
# into a folder by themselves.

# vitrail_plain_headers(variable file name...): the folder in which the names, files or folders, are found as `file` is.
function(vitrail_plain_headers variable file)
  if(DEFINED CACHE{${variable}})
    return()
  endif()
  find_path(found ${file} NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED HINTS $ENV{VULKAN_SDK}/Include $ENV{VULKAN_SDK}/Include/Volk)
  if(CMAKE_CROSSCOMPILING)
    set(folder ${PROJECT_BINARY_DIR}/plain_headers/${variable})
    file(MAKE_DIRECTORY ${folder})
    foreach(name ${ARGN})
      file(CREATE_LINK ${found}/${name} ${folder}/${name} SYMBOLIC)
    endforeach()
    set(found ${folder})
  endif()
  set(${variable} ${found} CACHE PATH "Where ${file} is")
endfunction()
