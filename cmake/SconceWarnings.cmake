# Warnings, numerics and sanitizers of our own code; linked PRIVATE so that they never reach a host.
add_library(sconce_warnings INTERFACE)
target_compile_options(sconce_warnings INTERFACE
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    -ffp-contract=off # the CPU twins of the shaders must round as the GPU does
    -fno-math-errno -fno-trapping-math # roots without errno, comparisons without traps, which nobody asks for: the same numbers with fewer branches
    $<$<BOOL:${SCONCE_WERROR}>:-Werror>)
if(SCONCE_SANITIZE)
    target_compile_options(sconce_warnings INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
    add_link_options(-fsanitize=address,undefined)
    set(SCONCE_KEEP_MODULES ${PROJECT_SOURCE_DIR}/tests/sanitizers/keep_modules.cpp)
    target_sources(sconce_warnings INTERFACE $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${SCONCE_KEEP_MODULES}>)
endif()
