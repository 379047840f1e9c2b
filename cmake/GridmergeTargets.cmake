# What every target of the project shares. Warnings, sanitizers and the floating-point contract are PRIVATE: a project
# that links gridmerge keeps its own flags.

function(gridmerge_configure target)
  target_compile_features(${target} PUBLIC cxx_std_20)
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

# gridmerge_add_library(<name> SOURCES ... [PUBLIC libs...] [PRIVATE libs...]): builds libgridmerge_<name>, exported as
# gridmerge::<name>.
function(gridmerge_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target gridmerge_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(gridmerge::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  gridmerge_configure(${target})
  set_property(GLOBAL APPEND PROPERTY GRIDMERGE_LIBRARIES ${target})
endfunction()
