# sconce_shaders(TARGET name SOURCES a.comp b.vert ... [VARIANTS source.comp:NAME:DEFINE[,DEFINE] ...])
# Compiles GLSL with glslang, checks it with spirv-val and embeds it: <build>/spirv/<name>.h declares one
# `inline constexpr uint32_t name_stage[]` a shader (dots become underscores).
find_program(SCONCE_GLSLANG glslangValidator REQUIRED)
find_program(SCONCE_SPIRV_VAL spirv-val REQUIRED)

function(sconce_add_spirv out_header source variable)
    set(spv ${CMAKE_CURRENT_BINARY_DIR}/spirv/${variable}.spv)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/spirv/${variable}.h)
    add_custom_command(OUTPUT ${header} DEPENDS ${source} DEPFILE ${spv}.d VERBATIM
        COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/spirv
        COMMAND ${SCONCE_GLSLANG} --quiet --target-env vulkan1.2 -I${PROJECT_SOURCE_DIR}/shaders ${ARGN}
                --depfile ${spv}.d -o ${header} --vn ${variable} ${source}
        COMMAND ${SCONCE_GLSLANG} --quiet --target-env vulkan1.2 -I${PROJECT_SOURCE_DIR}/shaders ${ARGN} -o ${spv} ${source}
        COMMAND ${SCONCE_SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${spv}
        COMMENT "Shader ${variable}")
    set(${out_header} ${header} PARENT_SCOPE)
endfunction()

function(sconce_shaders)
    cmake_parse_arguments(ARG "" "TARGET" "SOURCES;VARIANTS" ${ARGN})
    set(headers)
    foreach(source IN LISTS ARG_SOURCES)
        get_filename_component(variable ${source} NAME)
        string(REPLACE "." "_" variable ${variable})
        sconce_add_spirv(header ${CMAKE_CURRENT_SOURCE_DIR}/${source} ${variable})
        list(APPEND headers ${header})
    endforeach()
    foreach(variant IN LISTS ARG_VARIANTS)
        string(REPLACE ":" ";" parts ${variant})
        list(GET parts 0 source)
        list(GET parts 1 variable)
        list(GET parts 2 defines)
        string(REPLACE "," ";-D" defines ${defines})
        sconce_add_spirv(header ${CMAKE_CURRENT_SOURCE_DIR}/${source} ${variable} -D${defines})
        list(APPEND headers ${header})
    endforeach()
    add_custom_target(${ARG_TARGET}_spirv DEPENDS ${headers})
    add_library(${ARG_TARGET} INTERFACE)
    add_dependencies(${ARG_TARGET} ${ARG_TARGET}_spirv)
    target_include_directories(${ARG_TARGET} INTERFACE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
