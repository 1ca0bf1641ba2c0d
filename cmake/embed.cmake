# For programs that embed the compiler: cmake --install build/host --prefix FOLDER --component embed, and in their own
# CMakeLists.txt find_package(RoboSync) and target_link_libraries(… RoboSync::compiler). See tests/package/embed.
include(CMakePackageConfigHelpers)

set(packages lib/cmake/RoboSync)
set_target_properties(robosync_compiler PROPERTIES EXPORT_NAME compiler)
set_target_properties(robosync_vm PROPERTIES EXPORT_NAME vm)
target_include_directories(robosync_vm INTERFACE $<INSTALL_INTERFACE:include/robosync>)
target_compile_features(robosync_vm INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)
install(TARGETS robosync_compiler robosync_vm EXPORT RoboSync ARCHIVE DESTINATION lib COMPONENT embed)
install(EXPORT RoboSync NAMESPACE RoboSync:: FILE RoboSyncTargets.cmake DESTINATION ${packages} COMPONENT embed)
install(DIRECTORY compiler vm DESTINATION include/robosync COMPONENT embed
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.def")

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/RoboSyncConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/RoboSyncConfig.cmake INSTALL_DESTINATION ${packages})
# Until 1.0, each version may change the interface for programs that embed the compiler.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/RoboSyncConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/RoboSyncConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/RoboSyncConfigVersion.cmake
        DESTINATION ${packages} COMPONENT embed)
