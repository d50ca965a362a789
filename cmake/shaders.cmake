# shaders/NAME.comp -> NAME.spv -> NAME.spv.h, an array of words in which every float operation is
# decorated NoContraction (tools/embed_shader.c). In between spirv-opt inlines the functions and drops
# what nothing needs, which drivers do far slower, and at every start.

set(SPIRV_OPT_PASSES
    --inline-entry-points-exhaustive --eliminate-dead-functions --private-to-local
    --scalar-replacement=0 --ssa-rewrite --ccp --simplify-instructions --eliminate-dead-branches
    --merge-blocks --copy-propagate-arrays --reduce-load-size --redundancy-elimination
    --eliminate-dead-code-aggressive --compact-ids)

add_executable(embed_shader ${CMAKE_SOURCE_DIR}/tools/embed_shader.c
               ${CMAKE_SOURCE_DIR}/src/gpu/spirv.c ${CMAKE_SOURCE_DIR}/src/gpu/spirv_check.c
               ${CMAKE_SOURCE_DIR}/src/base/status.c)
target_include_directories(embed_shader PRIVATE ${CMAKE_SOURCE_DIR}/src)

# Compiles one kernel to OUTPUT_HEADER as `static const uint32_t SYMBOL[]`. With AS_WRITTEN behind
# that, what no code uses stays in it.
function(lavaray_compile_shader source symbol output_header)
  set(spv ${output_header}.spv)
  set(decorated ${output_header}.decorated.spv)
  set(optimized ${output_header}.optimized.spv)
  set(passes ${SPIRV_OPT_PASSES})
  if("AS_WRITTEN" IN_LIST ARGN)
    set(passes "")
  endif()
  add_custom_command(
    OUTPUT ${output_header}
    COMMAND ${GLSLANG_VALIDATOR} -V --quiet --target-env vulkan1.1
            -I${CMAKE_SOURCE_DIR}/shaders --depfile ${spv}.d -o ${spv} ${source}
    COMMAND embed_shader --decorate ${spv} ${decorated}
    COMMAND ${SPIRV_OPT} ${passes} ${decorated} -o ${optimized}
    COMMAND embed_shader ${optimized} ${symbol} ${output_header}
    DEPENDS ${source} embed_shader
    DEPFILE ${spv}.d
    COMMENT "Shader ${symbol}"
    VERBATIM)
endfunction()

# Makes every kernel in shaders/ a header in the target's include path: #include "trace.spv.h".
function(lavaray_embed_shaders target)
  file(GLOB kernels CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.comp)
  set(directory ${CMAKE_BINARY_DIR}/shaders)
  file(MAKE_DIRECTORY ${directory})
  foreach(kernel ${kernels})
    get_filename_component(name ${kernel} NAME_WE)
    lavaray_compile_shader(${kernel} ${name}_spv ${directory}/${name}.spv.h)
    list(APPEND headers ${directory}/${name}.spv.h)
  endforeach()
  target_sources(${target} PRIVATE ${headers})
  target_include_directories(${target} PRIVATE ${directory})
endfunction()
