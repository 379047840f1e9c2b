# install(): the components with their headers, the command line tool, and the package files for
# find_package(gridmerge COMPONENTS ...) and pkg-config. `cmake --install BUILD --component core` installs one component.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gridmerge)
set(GRIDMERGE_PACKAGES_OF "")  # set() lines for the package's configuration file

# What consumers have to find as well: for static libraries all that a library links, for shared ones nothing. What
# stands in $<BUILD_INTERFACE:> is for the build alone.
function(gridmerge_packages_named_by target out)
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  string(REGEX REPLACE "\\$<BUILD_INTERFACE:[^<>]*>" "" links "${links}")
  set(named "")
  foreach(package IN LISTS ARGN)
    if("${links}" MATCHES "(^|[;:<])${package}(::|;|>|$)")
      list(APPEND named ${package})
    endif()
  endforeach()
  set(${out} ${named} PARENT_SCOPE)
endfunction()

foreach(component IN LISTS GRIDMERGE_COMPONENTS)
  set(target gridmerge_${component})
  if(NOT TARGET ${target})
    continue()
  endif()
  install(TARGETS ${target} EXPORT gridmerge-${component}-targets COMPONENT ${component})
  install(EXPORT gridmerge-${component}-targets NAMESPACE gridmerge:: DESTINATION ${package_dir} COMPONENT ${component})
  foreach(room IN LISTS gridmerge_${component}_rooms)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/gridmerge/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridmerge
            COMPONENT ${component} FILES_MATCHING PATTERN "*.hpp")
  endforeach()

  gridmerge_packages_named_by(${target} packages ${gridmerge_${component}_packages})
  string(APPEND GRIDMERGE_PACKAGES_OF "set(gridmerge_${component}_packages ${packages})\n"
                                      "set(gridmerge_${component}_needs ${gridmerge_${component}_needs})\n")
  foreach(package IN LISTS packages)
    string(APPEND GRIDMERGE_PACKAGES_OF "set(gridmerge_debian_${package} ${gridmerge_debian_${package}})\n")
  endforeach()

  set(PC_NAME ${component})
  list(TRANSFORM gridmerge_${component}_needs PREPEND gridmerge- OUTPUT_VARIABLE PC_REQUIRES)
  list(JOIN PC_REQUIRES ", " PC_REQUIRES)
  set(PC_LIBS_PRIVATE "")
  foreach(package IN LISTS packages)
    string(APPEND PC_LIBS_PRIVATE " ${gridmerge_link_${package}}")
  endforeach()
  file(RELATIVE_PATH PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/gridmerge.pc.in ${PROJECT_BINARY_DIR}/gridmerge-${component}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/gridmerge-${component}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT ${component})
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/include/gridmerge/gridmerge.hpp ${PROJECT_SOURCE_DIR}/include/gridmerge/export.hpp
              ${PROJECT_BINARY_DIR}/include/gridmerge/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridmerge COMPONENT core)
if(TARGET gridmerge_cli)
  install(TARGETS gridmerge_cli COMPONENT tool)
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gridmergeConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/gridmergeConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gridmergeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gridmergeConfig.cmake ${PROJECT_BINARY_DIR}/gridmergeConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT core)
# For packages of which neither CMake nor they themselves say how they are found.
install(FILES ${PROJECT_SOURCE_DIR}/cmake/Findlz4.cmake ${PROJECT_SOURCE_DIR}/cmake/Findzstd.cmake
        DESTINATION ${package_dir} COMPONENT bag)
