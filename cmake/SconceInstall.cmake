# What find_package(sconce) gives a host: sconce::runtime, sconce::scene and sconce::svo with their headers, and the GLSL that its own
# shaders include. All headers live under include/sconce, so that #include "runtime/frame/indirect_light.h" reads the same there as here.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(headers ${CMAKE_INSTALL_INCLUDEDIR}/sconce)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/sconce)
foreach(name base runtime scene svo shader_headers)
    set_target_properties(sconce_${name} PROPERTIES EXPORT_NAME ${name})
    target_include_directories(sconce_${name} INTERFACE $<INSTALL_INTERFACE:${headers}> $<INSTALL_INTERFACE:${headers}/shaders>)
endforeach()
install(TARGETS sconce_base sconce_runtime sconce_scene sconce_svo sconce_shader_headers EXPORT sconce)
install(EXPORT sconce NAMESPACE sconce:: FILE sconce-targets.cmake DESTINATION ${package})

install(DIRECTORY base runtime svo DESTINATION ${headers} FILES_MATCHING PATTERN "*.h")
foreach(name builtin_scenes mesh_builder probe_grid scene scene_check) # the glTF import stays with the command
    install(FILES scene/${name}.h DESTINATION ${headers}/scene)
endforeach()
install(DIRECTORY shaders/shared DESTINATION ${headers}/shaders FILES_MATCHING PATTERN "*.h")
install(FILES shaders/light_field.glsl DESTINATION ${headers}/shaders)

configure_package_config_file(cmake/sconce-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/sconce-config.cmake INSTALL_DESTINATION ${package}
    PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/sconce-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sconce-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/sconce-config-version.cmake DESTINATION ${package})
