# What add_subdirectory() of this project gives a host: what find_package(sconce) does, <sconce/sconce.h> as it is installed.
set(flatten ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DIN=runtime/sconce.h -DOUT=${PROJECT_BINARY_DIR}/include/sconce/sconce.h
    -P ${PROJECT_SOURCE_DIR}/cmake/SconceFlatten.cmake)
execute_process(COMMAND ${flatten} COMMAND_ERROR_IS_FATAL ANY)
foreach(folder base runtime scene svo)
    file(GLOB_RECURSE headers ${PROJECT_SOURCE_DIR}/${folder}/*.h)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers})
endforeach()
target_include_directories(sconce_runtime INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>)
