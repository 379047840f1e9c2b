# install(): the libraries, their headers, the command line tool, and the package files for find_package(gridmerge).
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY GRIDMERGE_LIBRARIES)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gridmerge)

install(TARGETS ${libraries} EXPORT gridmergeTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/gridmerge DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT gridmergeTargets NAMESPACE gridmerge:: DESTINATION ${package_dir})
if(TARGET gridmerge_cli)
  install(TARGETS gridmerge_cli)
endif()

# Other packages whose targets the installed libraries still name: all of them for static libraries, the public ones
# alone for shared ones.
set(GRIDMERGE_PACKAGES "")
foreach(library IN LISTS libraries)
  get_target_property(links ${library} INTERFACE_LINK_LIBRARIES)
  foreach(package TBB Ceres PNG JPEG ZLIB yaml-cpp nlohmann_json fmt)
    if("${links}" MATCHES "(^|[;:<])${package}(::|;|>|$)")
      list(APPEND GRIDMERGE_PACKAGES ${package})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES GRIDMERGE_PACKAGES)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gridmergeConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/gridmergeConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gridmergeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gridmergeConfig.cmake ${PROJECT_BINARY_DIR}/gridmergeConfigVersion.cmake
        DESTINATION ${package_dir})
