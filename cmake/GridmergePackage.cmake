# CPack: Debian packages. `gridmerge` has the command line tool; `libgridmerge-dev` the libraries, their headers and the
# files for find_package() and pkg-config. `./dev release` makes them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gridmerge)
set(CPACK_PACKAGE_VENDOR gridmerge)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "merges occupancy grid maps of several robots")
set(GRIDMERGE_MAINTAINER "The gridmerge developers <gridmerge@example.org>" CACHE STRING
    "Name and address in packages: who distributes them answers for them")
set(CPACK_PACKAGE_CONTACT ${GRIDMERGE_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL tool ${GRIDMERGE_COMPONENTS})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_TOOL_PACKAGE_NAME gridmerge)
set(CPACK_DEBIAN_TOOL_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOL_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOL_DESCRIPTION "Takes the maps that robots built without knowing where the others were, and
returns one map, the transform of every input, and a verdict on each join.")

# What a program takes to be linked with the core; the other components, of which it may want none, take the rest.
set(dev_depends "")
set(dev_recommends "")
foreach(component IN LISTS GRIDMERGE_COMPONENTS)
  if(NOT TARGET gridmerge_${component})
    continue()
  endif()
  gridmerge_packages_named_by(gridmerge_${component} packages ${gridmerge_${component}_packages})
  foreach(package IN LISTS packages)
    if(component STREQUAL core)
      list(APPEND dev_depends ${gridmerge_debian_${package}})
    else()
      list(APPEND dev_recommends ${gridmerge_debian_${package}})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES dev_recommends)
list(JOIN dev_depends ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
list(JOIN dev_recommends ", " CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libgridmerge-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "C++ libraries with their headers: grids, matching of two maps, merging of
many, map files, ROS bags, simulated maps, evaluation, reports.")

# What Debian wants to find in usr/share/doc.
set(documents ${PROJECT_BINARY_DIR}/debian)
string(TIMESTAMP GRIDMERGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH, where that is set
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/copyright ${documents}/copyright COPYONLY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${documents}/changelog.Debian @ONLY)
find_program(GRIDMERGE_GZIP gzip)
if(GRIDMERGE_GZIP)
  execute_process(COMMAND ${GRIDMERGE_GZIP} -9 -n -k -f ${documents}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${documents}/copyright ${documents}/changelog.Debian.gz DESTINATION share/doc/gridmerge COMPONENT tool)
  install(FILES ${documents}/copyright ${documents}/changelog.Debian.gz DESTINATION share/doc/libgridmerge-dev
          COMPONENT core)
endif()

include(CPack)
cpack_add_component_group(tool)
cpack_add_component_group(dev)
cpack_add_component(tool GROUP tool)
foreach(component IN LISTS GRIDMERGE_COMPONENTS)
  cpack_add_component(${component} GROUP dev)
endforeach()
