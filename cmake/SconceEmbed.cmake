# sconce_embed(NAME FILE): <build>/embedded/NAME.h declares `inline constexpr unsigned char NAME[]`, the bytes of FILE; its path is in ${NAME}.
if(CMAKE_SCRIPT_MODE_FILE)
    file(READ ${SOURCE} bytes HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    file(WRITE ${HEADER} "#pragma once\n\ninline constexpr unsigned char ${NAME}[] = {${bytes}};\n")
    return()
endif()

set(SCONCE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(sconce_embed name file)
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    set(header ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.h)
    add_custom_command(OUTPUT ${header} DEPENDS ${source} ${SCONCE_EMBED_SCRIPT} VERBATIM
        COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DHEADER=${header} -DNAME=${name} -P ${SCONCE_EMBED_SCRIPT}
        COMMENT "Embedding ${file}")
    set(${name} ${header} PARENT_SCOPE)
endfunction()
