# What every target of the project shares. Warnings, sanitizers and the floating-point contract are PRIVATE: a project
# that links gridmerge keeps its own flags.

function(gridmerge_configure target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # A shared library shows what GRIDMERGE_EXPORT and GRIDMERGE_INTERNAL_EXPORT mark.
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  # What is in src/ is gridmerge::internal: the project's own targets see it, an installed library does not have it.
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -ffp-contract=off)
  if(GRIDMERGE_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${GRIDMERGE_SANITIZE} -fno-sanitize-recover=all
                                             -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${GRIDMERGE_SANITIZE})
  endif()
  if(GRIDMERGE_BUILD_FUZZERS)
    # libFuzzer finds its way through the libraries by their coverage.
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    target_link_options(${target} PUBLIC -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# gridmerge_choose_components(): an option for each component, GRIDMERGE_WITH_MERGE and so on. GRIDMERGE_WITH_ALL_AT_TOP
# says whether this is the top project, and nothing is left out but what the command line tool can do without.
macro(gridmerge_choose_components)
  set(GRIDMERGE_WITH_ALL_AT_TOP ${PROJECT_IS_TOP_LEVEL})
  set(GRIDMERGE_WITH_CORE ON)
  foreach(component IN LISTS GRIDMERGE_COMPONENTS)
    string(TOUPPER ${component} upper)
    if(NOT component STREQUAL core)
      option(GRIDMERGE_WITH_${upper} "Build the component ${component}" ON)
    endif()
    if(NOT GRIDMERGE_WITH_${upper})
      if(NOT component STREQUAL dds)  # the tool has no `gridmerge node` then
        set(GRIDMERGE_WITH_ALL_AT_TOP OFF)
      endif()
      continue()
    endif()
    foreach(needed IN LISTS gridmerge_${component}_needs)
      string(TOUPPER ${needed} needed_upper)
      if(NOT GRIDMERGE_WITH_${needed_upper})
        message(FATAL_ERROR "gridmerge's component ${component} needs ${needed}: leave both out "
                            "(-DGRIDMERGE_WITH_${upper}=OFF) or neither")
      endif()
    endforeach()
  endforeach()
endmacro()

# gridmerge_find_packages(): what the chosen components need.
macro(gridmerge_find_packages)
  foreach(component IN LISTS GRIDMERGE_COMPONENTS)
    string(TOUPPER ${component} upper)
    if(NOT GRIDMERGE_WITH_${upper})
      continue()
    endif()
    foreach(package IN LISTS gridmerge_${component}_packages)
      find_package(${package} ${gridmerge_version_${package}} QUIET)
      if(NOT ${package}_FOUND)
        set(instead "")
        if(NOT component STREQUAL core)
          set(instead ", or leave it out: -DGRIDMERGE_WITH_${upper}=OFF, and so what needs it")
        endif()
        message(FATAL_ERROR "gridmerge's component ${component} needs ${package}: install it "
                            "(Debian: ${gridmerge_debian_${package}})${instead}")
      endif()
    endforeach()
  endforeach()
endmacro()

# gridmerge_with_internals(<list>): each gridmerge::<name> of it becomes a library of the same objects that hides nothing.
# A static library is one; beside a shared one stands the archive gridmerge_<name>_objects, which is not installed.
macro(gridmerge_with_internals libraries)
  if(BUILD_SHARED_LIBS)
    list(TRANSFORM ${libraries} REPLACE "^gridmerge::(.+)$" "gridmerge_\\1_objects")
  endif()
endmacro()

# gridmerge_link_internals(<target> <library>...): what target_link_libraries() does, for a program that uses more of
# gridmerge::internal than shared libraries show: tests, benchmarks, experiments.
function(gridmerge_link_internals target)
  set(libraries ${ARGN})
  gridmerge_with_internals(libraries)
  target_link_libraries(${target} PRIVATE ${libraries})
endfunction()

# gridmerge_add_component(<name> SOURCES ... [PUBLIC libs...] [PRIVATE libs...]): builds libgridmerge_<name>, exported as
# gridmerge::<name>, unless it is left out.
function(gridmerge_add_component name)
  string(TOUPPER ${name} upper)
  if(NOT GRIDMERGE_WITH_${upper})
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target gridmerge_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(gridmerge::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                                             VERSION ${PROJECT_VERSION}
                                             SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  set(headers PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                     $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} ${headers})
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  gridmerge_configure(${target})
  if(BUILD_SHARED_LIBS)
    # A shared library takes the same objects as a static one, so a compiler cache serves both.
    set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "" LINK_DEPENDS ${PROJECT_SOURCE_DIR}/src/hidden.map)
    target_link_options(${target} PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/src/hidden.map)
    if(NOT GRIDMERGE_SANITIZE)
      # What another component hides is missed here, not by whoever links this one.
      target_link_options(${target} PRIVATE LINKER:--no-undefined)
    endif()
    add_library(${target}_objects STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${target}>)
    set_target_properties(${target}_objects PROPERTIES LINKER_LANGUAGE CXX)
    target_include_directories(${target}_objects ${headers})
    gridmerge_with_internals(ARG_PUBLIC)
    gridmerge_with_internals(ARG_PRIVATE)
    target_link_libraries(${target}_objects PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    gridmerge_configure(${target}_objects)
  endif()
endfunction()
