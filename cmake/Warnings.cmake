# The project's own targets are compiled with warnings, which are errors where the project is not part of a host's build:
# a host's compiler may know other warnings. Visual Studio's, which nobody runs here, only warns.
function(vitrail_warnings target)
  if(MSVC)
    target_compile_options(${target} PRIVATE /W4)
    return()
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# For programs of tests: compiles in half the time of -O3.
function(vitrail_compile_quickly target)
  if(NOT MSVC)
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()
