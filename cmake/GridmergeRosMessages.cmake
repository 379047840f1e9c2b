# GRIDMERGE_ROS_MESSAGES_SOURCE and GRIDMERGE_ROS_MESSAGES_DIR: what idlc makes of src/dds/ros_messages.idl.
find_program(GRIDMERGE_IDLC idlc)
if(NOT GRIDMERGE_IDLC)
  message(FATAL_ERROR "gridmerge's component dds needs idlc: install it (Debian: cyclonedds-tools), or leave it out: "
                      "-DGRIDMERGE_WITH_DDS=OFF")
endif()

set(GRIDMERGE_ROS_MESSAGES_DIR ${PROJECT_BINARY_DIR}/dds)
set(GRIDMERGE_ROS_MESSAGES_SOURCE ${GRIDMERGE_ROS_MESSAGES_DIR}/ros_messages.c)
file(MAKE_DIRECTORY ${GRIDMERGE_ROS_MESSAGES_DIR})
set(idl ${CMAKE_CURRENT_SOURCE_DIR}/dds/ros_messages.idl)
# -t: without descriptions of the types. Where they have some, Cyclone DDS 0.10 ends the program when it meets newer ones.
add_custom_command(
  OUTPUT ${GRIDMERGE_ROS_MESSAGES_SOURCE} ${GRIDMERGE_ROS_MESSAGES_DIR}/ros_messages.h
  COMMAND ${GRIDMERGE_IDLC} -t -o ${GRIDMERGE_ROS_MESSAGES_DIR} ${idl}
  DEPENDS ${idl}
  COMMENT "Compiling ros_messages.idl"
  VERBATIM)
# C that C++ takes as well, once alignof has its name: so no C compiler is needed.
set_source_files_properties(${GRIDMERGE_ROS_MESSAGES_SOURCE} PROPERTIES LANGUAGE CXX
                                                                        COMPILE_OPTIONS "-w;-D_Alignof=alignof")
