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
install(TARGETS sconce_base sconce_runtime sconce_scene sconce_svo sconce_shader_headers EXPORT sconce)
install(EXPORT sconce NAMESPACE sconce:: FILE sconce-targets.cmake DESTINATION ${package})

install(CODE "execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DIN=runtime/sconce.h
    -DOUT=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${headers}/sconce.h -P ${PROJECT_SOURCE_DIR}/cmake/SconceFlatten.cmake COMMAND_ERROR_IS_FATAL ANY)")
set(shared_headers brdf brdf_text chart color face_chain face_march field_passes frame gpu_types hidden_light lamps light_cells light_field light_lookup live_text octree_descent prefiltered
    probe_trace pure_text ray_query ray_state refined sample_pair surface_light texel)
list(TRANSFORM shared_headers REPLACE "(.+)" "shaders/shared/\\1.h")
install(FILES ${shared_headers} DESTINATION ${headers}/shaders/shared)
install(FILES shaders/light_field.glsl DESTINATION ${headers}/shaders)

configure_package_config_file(cmake/sconce-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/sconce-config.cmake INSTALL_DESTINATION ${package}
    PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/sconce-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sconce-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/sconce-config-version.cmake DESTINATION ${package})
