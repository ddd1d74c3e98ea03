# Makes all of src/kernels/kernels.table and of src/kernels/raster/kernels.table, which say what their columns mean.

# The values of a cell of an axis: `-` stays one, which stands for any.
function(kernel_axis cell each result)
  if(cell STREQUAL "each")
    set(${result} ${each} PARENT_SCOPE)
  else()
    set(${result} ${cell} PARENT_SCOPE)
  endif()
endfunction()

# resolve_long: ResolveLong
function(kernel_enumerator name result)
  string(REPLACE _ ";" words ${name})
  set(joined)
  foreach(word ${words})
    string(SUBSTRING ${word} 0 1 first)
    string(SUBSTRING ${word} 1 -1 rest)
    string(TOUPPER ${first} first)
    string(APPEND joined ${first}${rest})
  endforeach()
  set(${result} ${joined} PARENT_SCOPE)
endfunction()

# Compiles one variant for `api`, vulkan or opengl, and appends it to `includes` and `variants` of the caller.
function(embed_variant target table row api color samples sorting access)
  list(GET row 0 name)
  list(GET row 1 entry)
  list(GET row 6 optimize)
  list(GET row 7 defines)
  get_filename_component(folder ${table} DIRECTORY)
  get_filename_component(stage ${entry} LAST_EXT)
  string(SUBSTRING ${stage} 1 -1 stage)
  if(defines STREQUAL -)
    set(defines)
  endif()
  string(REPLACE , ";" defines "${defines}")
  if(NOT color STREQUAL -)
    list(APPEND defines VITRAIL_COLOR_FORMAT=${color})
  endif()
  if(samples STREQUAL several)
    list(APPEND defines VITRAIL_MULTISAMPLED)
  endif()
  if(sorting STREQUAL networks)
    list(APPEND defines VITRAIL_NETWORKS=1)
  else()
    list(APPEND defines VITRAIL_NETWORKS=0)
  endif()
  if(access STREQUAL address)
    list(APPEND defines VITRAIL_BUFFER_REFERENCE)
  endif()
  set(symbol ${stage}_${name})
  set(environment vulkan1.2)
  if(api STREQUAL opengl)
    list(APPEND defines VITRAIL_OPENGL)
    set(symbol gl_${symbol})
    set(environment opengl)
    set(optimize -O0) # NVIDIA makes slower code of optimized modules
  endif()
  foreach(value ${color} ${samples} ${sorting} ${access})
    if(NOT value STREQUAL -)
      string(APPEND symbol _${value})
    endif()
  endforeach()
  embed_shader(
    TARGETS ${target}
    NAME ${symbol}
    SOURCE ${folder}/${entry}
    NAMESPACE vitrail
    INCLUDES ${PROJECT_SOURCE_DIR}/shaders ${folder}
    DEFINES ${defines}
    OPTIMIZE ${optimize}
    ENVIRONMENT ${environment})
  kernel_enumerator(${name} enumerator)
  string(REPLACE - any axes "${color}, ${samples}, ${sorting}, ${access}")
  set(includes "${includes}#include \"shaders/${symbol}.h\"\n" PARENT_SCOPE)
  set(variants "${variants}VITRAIL_VARIANT(${stage}, ${enumerator}, ${axes}, ${symbol})\n" PARENT_SCOPE)
endfunction()

# list_kernels(table): makes in generated/kernels
#   names.inc   VITRAIL_KERNEL(stage, Enumerator, "name") a kernel, which is what the core knows of them
#   rows.inc    VITRAIL_ROW(stage, Enumerator, samples, sorting, "file", "defines") a row, for backends that compile at run
#               time; an axis is a value, `each` or `any`
# Nothing is compiled.
function(list_kernels table)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${table})
  file(STRINGS ${table} lines REGEX "^[^#]")
  set(known)
  foreach(line ${lines})
    string(REGEX REPLACE "[ \t]+" ";" row "${line}")
    list(GET row 0 name)
    list(GET row 1 entry)
    string(REGEX MATCH "[a-z]+$" stage ${entry})
    if(NOT ${stage}_${name} IN_LIST known)
      list(APPEND known ${stage}_${name})
      kernel_enumerator(${name} enumerator)
      string(REPLACE _ " " words ${name})
      string(APPEND names "VITRAIL_KERNEL(${stage}, ${enumerator}, \"${words}\")\n")
    endif()
    list(GET row 3 samples)
    list(GET row 4 sorting)
    list(GET row 7 defines)
    string(REPLACE - any axes "${samples}, ${sorting}")
    string(REGEX REPLACE "^-$" "" defines ${defines})
    kernel_enumerator(${name} enumerator)
    string(APPEND rows "VITRAIL_ROW(${stage}, ${enumerator}, ${axes}, \"${entry}\", \"${defines}\")\n")
  endforeach()
  write_kernel_list(names "${names}")
  write_kernel_list(rows "${rows}")
endfunction()

function(write_kernel_list file content)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/generated/kernels/${file}.inc @ONLY
       CONTENT "// Made by cmake/KernelTable.cmake.\n${content}")
endfunction()

# embed_kernels(target table api): gives the target, of this folder, every kernel (api vulkan), or those that the table
# has as modules for OpenGL (api opengl), and makes in generated/kernels
#   API_includes.inc   the headers with the words of all variants
#   API_variants.inc   VITRAIL_VARIANT(stage, Enumerator, color, samples, sorting, access, symbol) a variant, each axis a value
#                      or `any`
function(embed_kernels target table api)
  file(STRINGS ${table} rows REGEX "^[^#]")
  foreach(line ${rows})
    string(REGEX REPLACE "[ \t]+" ";" row "${line}")
    list(GET row 2 color)
    list(GET row 3 samples)
    list(GET row 4 sorting)
    list(GET row 5 access)
    kernel_axis(${color} "rgba16f;rgba32f" colors)
    kernel_axis(${samples} "one;several" samples)
    kernel_axis(${sorting} "networks;insertion" sortings)
    kernel_axis(${access} "binding;address" accesses)
    if(api STREQUAL opengl)
      list(GET row 8 form)
      if(NOT form STREQUAL module)
        continue()
      endif()
      set(accesses binding)
    endif()
    foreach(c ${colors})
      foreach(s ${samples})
        foreach(w ${sortings})
          foreach(a ${accesses})
            embed_variant(${target} ${table} "${row}" ${api} ${c} ${s} ${w} ${a})
          endforeach()
        endforeach()
      endforeach()
    endforeach()
  endforeach()
  write_kernel_list(${api}_includes "${includes}")
  write_kernel_list(${api}_variants "${variants}")
endfunction()

# embed_raster_kernels(target table): gives the target, of this folder, every kernel of the rasteriser in compute shaders,
# and makes in generated/kernels
#   raster_names.inc      VITRAIL_RASTER_KERNEL(Enumerator, "name", made) a kernel
#   raster_includes.inc   the headers with the words of all variants
#   raster_variants.inc   VITRAIL_RASTER_VARIANT(Enumerator, color, samples, symbol) a variant, each axis a value or `any`
function(embed_raster_kernels target table)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${table})
  get_filename_component(folder ${table} DIRECTORY)
  file(STRINGS ${table} rows REGEX "^[^#]")
  set(known)
  foreach(line ${rows})
    string(REGEX REPLACE "[ \t]+" ";" row "${line}")
    list(GET row 0 name)
    list(GET row 1 entry)
    list(GET row 2 made)
    list(GET row 3 color)
    list(GET row 4 samples)
    list(GET row 5 defines)
    kernel_enumerator(${name} enumerator)
    if(NOT name IN_LIST known)
      list(APPEND known ${name})
      string(REPLACE _ " " words ${name})
      string(APPEND names "VITRAIL_RASTER_KERNEL(${enumerator}, \"${words}\", ${made})\n")
    endif()
    string(REGEX REPLACE "^-$" "" defines ${defines})
    string(REPLACE , ";" defines "${defines}")
    kernel_axis(${color} "rgba16f;rgba32f" colors)
    kernel_axis(${samples} "one;several" counts)
    foreach(c ${colors})
      foreach(s ${counts})
        set(symbol raster_${name})
        set(variant ${defines})
        if(NOT c STREQUAL -)
          string(APPEND symbol _${c})
          list(APPEND variant VITRAIL_COLOR_FORMAT=${c})
        endif()
        if(NOT s STREQUAL -)
          string(APPEND symbol _${s})
        endif()
        if(s STREQUAL several)
          list(APPEND variant VITRAIL_MULTISAMPLED)
        endif()
        embed_shader(
          TARGETS ${target}
          NAME ${symbol}
          SOURCE ${folder}/${entry}
          NAMESPACE vitrail
          INCLUDES ${PROJECT_SOURCE_DIR}/shaders
          DEFINES ${variant})
        string(REPLACE - any axes "${c}, ${s}")
        string(APPEND includes "#include \"shaders/${symbol}.h\"\n")
        string(APPEND variants "VITRAIL_RASTER_VARIANT(${enumerator}, ${axes}, ${symbol})\n")
      endforeach()
    endforeach()
  endforeach()
  write_kernel_list(raster_names "${names}")
  write_kernel_list(raster_includes "${includes}")
  write_kernel_list(raster_variants "${variants}")
endfunction()
