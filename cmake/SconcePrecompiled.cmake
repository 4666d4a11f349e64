# sconce_precompile(TARGET GROUP HEADER...): a program whose files read headers of a group from what the compiler made of them once: the first program of the group
# has it made. Large headers of others only, since files must still include what they use: `cmake -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON` shows what doesn't.
function(sconce_precompile target group)
    get_property(first GLOBAL PROPERTY sconce_precompiled_${group})
    if(first)
        target_precompile_headers(${target} REUSE_FROM ${first})
    else()
        target_precompile_headers(${target} PRIVATE ${ARGN})
        set_property(GLOBAL PROPERTY sconce_precompiled_${group} ${target})
    endif()
endfunction()

# Programs with a command line.
function(sconce_command_line target)
    target_link_libraries(${target} PRIVATE CLI11::CLI11 nlohmann_json::nlohmann_json)
    sconce_precompile(${target} command_lines <CLI/CLI.hpp> <nlohmann/json.hpp> <fmt/format.h>)
endfunction()
