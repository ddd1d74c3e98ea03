# The project's own targets are compiled with warnings, which are errors where the project is not part of a host's build:
# a host's compiler may know other warnings.
function(vitrail_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
