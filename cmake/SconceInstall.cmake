# What find_package(sconce) gives a host: the target sconce::runtime, the one header <sconce/sconce.h>, and the GLSL that its own shaders include
# (${SCONCE_SHADERS} for their include path). tests/install/installed_tree.txt lists it file by file.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(headers ${CMAKE_INSTALL_INCLUDEDIR}/sconce)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/sconce)
foreach(name base runtime scene svo shader_headers)
    set_target_properties(sconce_${name} PROPERTIES EXPORT_NAME ${name})
    target_include_directories(sconce_${name} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${headers}/shaders>)
endforeach()
# base, scene and svo are what runtime links; a host names runtime alone.
install(TARGETS sconce_base sconce_runtime sconce_scene sconce_svo sconce_shader_headers EXPORT sconce COMPONENT library)
install(EXPORT sconce NAMESPACE sconce:: FILE sconce-targets.cmake DESTINATION ${package} COMPONENT library)

install(CODE "execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DIN=runtime/sconce.h
    -DOUT=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${headers}/sconce.h -P ${PROJECT_SOURCE_DIR}/cmake/SconceFlatten.cmake COMMAND_ERROR_IS_FATAL ANY)" COMPONENT library)
set(shared_headers brdf brdf_text chart color distance_block face_chain face_march field_passes frame gpu_types hidden_light lamps light_cells light_field light_lookup live_text octree_descent polygon_light prefiltered
    probe_trace pure_text radiance_block ray_query ray_state refined sample_pair surface_light texel)
list(TRANSFORM shared_headers REPLACE "(.+)" "shaders/shared/\\1.h")
install(FILES ${shared_headers} DESTINATION ${headers}/shaders/shared COMPONENT library)
set(glsl sconce sconce_frame sconce_probe_face host_names host_names_end light_field lamps probe_face) # hosts include the first three
list(TRANSFORM glsl REPLACE "(.+)" "shaders/\\1.glsl")
install(FILES ${glsl} DESTINATION ${headers}/shaders COMPONENT library)

configure_package_config_file(cmake/sconce-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/sconce-config.cmake INSTALL_DESTINATION ${package}
    PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/sconce-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sconce-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/sconce-config-version.cmake DESTINATION ${package}
    COMPONENT library)

# For builds without CMake. Its paths are from where it lies, so that what is installed may be moved.
file(RELATIVE_PATH SCONCE_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" SCONCE_UP "${SCONCE_UP}")
configure_file(cmake/sconce.pc.in ${CMAKE_CURRENT_BINARY_DIR}/sconce.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sconce.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)

# `cpack` in the build folder: sconce_*.deb with the command, libsconce-dev_*.deb with the library.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sconce)
set(CPACK_PACKAGE_CONTACT "The Sconce authors <sconce@invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL library)
if(SCONCE_TOOLS)
    list(APPEND CPACK_COMPONENTS_ALL command)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME sconce)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libsconce-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libglm-dev, libvulkan-dev, libxxhash-dev, libzstd-dev, pkg-config")
if(PROJECT_IS_TOP_LEVEL)
    include(CPack)
endif()
