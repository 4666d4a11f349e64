# Installs the build into a folder of its own, builds the examples against it as a reader would, and holds what they say against the command and
# against what can be written down. By hand, against a package that is installed already:
# cmake -DPREFIX=... -DEXAMPLES=examples -DWORK=... -DCONFIG=Release -DCOMPILER=c++ -DGENERATOR=Ninja -P examples_test.cmake
set(here ${CMAKE_CURRENT_LIST_DIR})

# step(NAME COMMAND...): must succeed, without a word of the validation layer. What it printed is then in `output`.
function(step name)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(FIND "${output}" "validation: " message)
    if(NOT status EQUAL 0 OR NOT message EQUAL -1)
        message(FATAL_ERROR "${name} failed (${status}):\n${output}")
    endif()
    message(STATUS "${name}\n${output}")
    set(output "${output}" PARENT_SCOPE)
endfunction()

# refused(CODE SENTENCE COMMAND...): must end with the exit code and print what matches the sentence.
function(refused code sentence)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL ${code} OR NOT output MATCHES "${sentence}")
        message(FATAL_ERROR "'${ARGN}' should end with ${code} and say '${sentence}', but it ended with ${status}:\n${output}")
    endif()
endfunction()

# expect(NAME PATTERN): `output` must have it.
function(expect name pattern)
    if(NOT output MATCHES "${pattern}")
        message(FATAL_ERROR "${name}: there is no '${pattern}' in\n${output}")
    endif()
endfunction()

# What a reader has to write: all that is not blank of the integration's files, and every line elsewhere in the host that has to do with them; and
# beside it what bakes by the host's own draws.
function(check_integration)
    set(lines 0)
    set(bake_lines 0)
    file(GLOB files ${EXAMPLES}/host/*.h ${EXAMPLES}/host/*.cpp ${EXAMPLES}/host/*.glsl ${EXAMPLES}/host/*.comp ${EXAMPLES}/host/*.vert
         ${EXAMPLES}/host/*.frag)
    foreach(file ${files})
        set(counted "[^ ]")
        if(file MATCHES "/(sconce_bake\\.[a-z]+|probe_face\\.frag)$")
            file(STRINGS ${file} found REGEX "${counted}")
            list(LENGTH found count)
            math(EXPR bake_lines "${bake_lines} + ${count}")
            continue()
        endif()
        if(NOT file MATCHES "/sconce_gi\\.[a-z]+$")
            set(counted "SconceGi|sconce_gi|indirectLight|^[^a-z]*gi\\.|[ ({]gi\\.")
            file(STRINGS ${file} known REGEX "sconce::|<sconce/|\"shared/|\"sconce\\.glsl|sconce_frame\\.glsl|light_field\\.glsl")
            if(known)
                message(FATAL_ERROR "${file} knows the library, which is for sconce_gi.* alone: ${known}")
            endif()
        endif()
        file(STRINGS ${file} found REGEX "${counted}")
        list(LENGTH found count)
        math(EXPR lines "${lines} + ${count}")
    endforeach()
    message(STATUS "The integration has ${lines} lines, and a bake by the host's own draws ${bake_lines} more.")
    if(bake_lines GREATER 150 OR bake_lines LESS 50)
        message(FATAL_ERROR "The host's bake has ${bake_lines} lines; 150 are allowed, and less than 50 can't be all of it.")
    endif()
    if(lines GREATER 150 OR lines LESS 50)
        message(FATAL_ERROR "The integration of examples/host has ${lines} lines; 150 are allowed, and less than 50 can't be all of it.")
    endif()
endfunction()

# build(FOLDER): an example, into ${WORK}/FOLDER.
function(build folder)
    step("Configuration of ${folder}" ${CMAKE_COMMAND} -S ${EXAMPLES}/${folder} -B ${WORK}/${folder} -G ${GENERATOR}
         -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_CXX_COMPILER=${COMPILER}
         -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_CXX_FLAGS=${FLAGS} -DKEEP_MODULES=${KEEP_MODULES})
    step("Build of ${folder}" ${CMAKE_COMMAND} --build ${WORK}/${folder} --config ${CONFIG})
endfunction()

# The same view by the command and by the host. Measured on software Vulkan, relMSE: direct light 4e-4, since shadows end by another filter;
# reflections 2e-6, where a ray of either slips past an edge; light that is read at surfaces, which has nothing by chance in it, 5e-7. Faults that were
# planted to see whether they are found: normals or an eye of the wrong hand 0.06 to 0.1 of reflections, prefiltered reflections added whole beside
# rays, rays from another roughness or from a hundred times as far off their surface 2e-4 to 7e-4 of them, albedo in place of what the diffuse lobe
# reflects 7e-4 of diffuse light.
function(compare_pictures name scene camera command_options host_options)
    step("${name} by the command" ${sconce} render ${WORK}/${scene}.gltf --field ${WORK}/${scene}.sconce --size 240x135 --camera ${camera} ${command_options}
         -o ${WORK}/${name}_command.exr)
    step("${name} by the host" ${WORK}/host/host ${WORK}/${scene}.gltf ${WORK}/${scene}.sconce -o ${WORK}/${name}.exr --size 240x135 --camera ${camera} --validation
         ${host_options})
    expect("${name}: all that was lent" "afterwards 0 bytes of device memory and 0 blocks of main memory, of [1-9]")
    foreach(limit direct:relmse=2e-3 diffuse_indirect:relmse=5e-6 glossy_indirect:relmse=1e-4 beauty:relmse=1e-3 beauty:flip=0.01)
        string(REPLACE ":" ";" parts ${limit})
        list(GET parts 0 layer)
        list(GET parts 1 most)
        step("${name}: ${limit}" ${sconce} compare ${WORK}/${name}.exr ${WORK}/${name}_command.exr --layer ${layer} --fail-above ${most})
    endforeach()
endfunction()

check_integration()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(ENV{SCONCE_VALIDATION} 1)
if(NOT PREFIX)
    set(PREFIX ${WORK}/prefix)
    step("Installation" ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${PREFIX})
endif()
set(sconce ${PREFIX}/bin/sconce)
build(host)
build(shader)

foreach(scene room furnace lamp)
    execute_process(COMMAND python3 -B ${here}/${scene}.py OUTPUT_FILE ${WORK}/${scene}.gltf COMMAND_ERROR_IS_FATAL ANY)
endforeach()
step("Bake of the room" ${sconce} bake ${WORK}/room.gltf --probes ${here}/probes.json -o ${WORK}/room.sconce --resolution 128 --bounces 3)
step("Bake of the furnace" ${sconce} bake ${WORK}/furnace.gltf --probes ${here}/middle.json -o ${WORK}/furnace.sconce --resolution 128)

compare_pictures(right_handed room 0 "" "")
compare_pictures(left_handed room 0 "" "--left-handed")
step("Left-handed is right-handed" ${sconce} compare ${WORK}/left_handed.exr ${WORK}/right_handed.exr --fail-above relmse=1e-8) # 5e-12
compare_pictures(corner room 1 "" "--left-handed")
compare_pictures(temporal room 0 "--temporal;--frames;3" "--frames;3")
compare_pictures(in_the_furnace furnace 0 "" "") # neither rays nor mirrors: their terms are not made

# The field of the room once more, by the host's own draws of what the probes see, in a world of either hand; rays gather through the field in both.
# Measured: diffuse light 2e-8, reflections 5e-7, FLIP of the picture 0.003; normals in the world of the other hand 0.08 of diffuse light, textures of
# normals without their spread FLIP 0.018.
function(compare_bakes name host_options)
    set(probes "")
    foreach(place -1.4,1.5,-1.2 1,1,1 1,2.2,-1.5 -0.9,0.9,1.1 -0.1,0.8,-1.1) # probes.json
        list(APPEND probes --probe ${place})
    endforeach()
    step("${name}: bake and picture by the host" ${WORK}/host/host ${WORK}/room.gltf ${WORK}/${name}.sconce -o ${WORK}/${name}.exr --size 240x135
         --validation ${probes} ${host_options})
    foreach(limit diffuse_indirect:relmse=1e-6 glossy_indirect:relmse=5e-6 beauty:flip=0.01)
        string(REPLACE ":" ";" parts ${limit})
        list(GET parts 0 layer)
        list(GET parts 1 most)
        step("${name}: ${limit}" ${sconce} compare ${WORK}/${name}.exr ${WORK}/through_the_field.exr --layer ${layer} --fail-above ${most})
    endforeach()
endfunction()
step("Bake through the field" ${sconce} bake ${WORK}/room.gltf --probes ${here}/probes.json -o ${WORK}/through_the_field.sconce --resolution 128 --bounces 3
     --gather field)
step("Its picture" ${WORK}/host/host ${WORK}/room.gltf ${WORK}/through_the_field.sconce -o ${WORK}/through_the_field.exr --size 240x135)
compare_bakes(baked_by_host "")
compare_bakes(baked_left_handed "--left-handed")

# In a closed box whose walls emit L = 1 and reflect a = 0.5099 of what arrives (white light on a rough dielectric of base colour 0.5, by
# hemisphericalAlbedo() of brdf.h), all light is L / (1 - a) = 2.040 from every side: irradiance pi times that, 6.41, of which surfaces reflect
# pi (2.040 - 1) = 3.27. Surface light is stored to 0.2 %, radiance and irradiance of probes to 1.6 %, blue to 3 %.
function(ask light)
    step("Questions, the light at ${light}" ${WORK}/shader/ask ${WORK}/furnace.sconce --validation --point 0.3,-1,0 --normal 0,1,0
         --ray 0.4,1,0 --light ${light})
    expect("Irradiance" "irradiance 6\\.4[0-2][0-9]+ 6\\.4[0-2][0-9]+ 6\\.4[0-2][0-9]+ W")
    expect("Irradiance of what surfaces reflect" "reflect 3\\.[23][0-9]+ 3\\.[23][0-9]+ 3\\.[23][0-9]+ W")
    # From (0.3, -1, 0) along (0.4, 1, 0) to the wall at x = 1: 0.7 / 0.4 of the direction's length, 1.077.
    expect("A ray" "the ray hits at 1\\.88[0-9]+ m\n  place (1\\.00|0\\.99)[0-9]+ 0\\.7[45][0-9]+ -?0\\.000[0-9] m\n  normal -1\\.0000 -?0\\.0")
    expect("Its radiance" "radiance (1\\.99|2\\.0)[0-9]+ (1\\.99|2\\.0)[0-9]+ (1\\.9[7-9]|2\\.[01])[0-9]+ W")
    set(output "${output}" PARENT_SCOPE)
endfunction()
ask(0.3,0.9,0)
expect("A light in the box" "the light reaches the point")
ask(0.3,3,0)
expect("A light behind the ceiling" "the light is hidden from the point")

# A square of 0.06 m that sends 1,000 W/(m^2 sr) lies 1.9 m above the floor's middle: irradiance 1000 * 0.0036 / 1.9^2 = 0.997, less a thousandth. Its
# light is a lamp's, which is no part of surface light; black metal reflects next to nothing of it.
step("Bake of the lamp" ${sconce} bake ${WORK}/lamp.gltf --probes ${here}/middle.json -o ${WORK}/lamp.sconce --resolution 128)
step("Light of a lamp" ${WORK}/shader/ask ${WORK}/lamp.sconce --validation --point 0,-1,0 --normal 0,1,0 --ray 1,1,0 --light 0,0.5,0)
expect("Irradiance below it" "irradiance (0\\.99|1\\.0[0-2])[0-9]+ ")
expect("What walls reflect of it" "reflect 0\\.0[0-2][0-9]+ ")

set(host ${WORK}/host/host)
refused(2 "two files and -o are needed" ${host} ${WORK}/room.gltf)
refused(2 "--size is '0'; give a number from 1 to 16384" ${host} ${WORK}/room.gltf ${WORK}/room.sconce -o x.exr --size 0x9)
refused(1 "can't be read as glTF" ${host} ${WORK}/room.sconce ${WORK}/room.sconce -o ${WORK}/x.exr)
refused(1 "is damaged: it does not begin as a .sconce file does" ${host} ${WORK}/room.gltf ${WORK}/room.gltf -o ${WORK}/x.exr)
refused(2 "--probe is '1,2'; write a place in metres" ${host} ${WORK}/room.gltf ${WORK}/room.sconce -o x.exr --probe 1,2)
refused(1 "--camera is 7, and .* has 2" ${host} ${WORK}/room.gltf ${WORK}/room.sconce -o ${WORK}/x.exr --camera 7)
refused(2 "four vectors are needed" ${WORK}/shader/ask ${WORK}/furnace.sconce --point 0,0,0)
# Each breaks one reference of the file: none may be followed.
file(READ ${WORK}/room.gltf room)
foreach(fault "\"bufferView\": 2|\"bufferView\": 99" "\"count\": [0-9]+|\"count\": 4000000" "\"material\": 4|\"material\": 40"
        "\"mesh\": 1|\"mesh\": 77" "\"children\": \\[[0-9]+\\]|\"children\": [7]" "\"light\": 0|\"light\": 5")
    string(REPLACE "|" ";" parts "${fault}")
    list(GET parts 0 right)
    list(GET parts 1 wrong)
    string(REGEX REPLACE "${right}" "${wrong}" broken "${room}")
    file(WRITE ${WORK}/broken.gltf "${broken}")
    if(broken STREQUAL room)
        message(FATAL_ERROR "The room has no '${right}' to break.")
    endif()
    refused(1 "export the file again|can't be read as glTF" ${host} ${WORK}/broken.gltf ${WORK}/room.sconce -o ${WORK}/x.exr --size 8x8)
endforeach()
