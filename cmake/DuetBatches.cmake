# Batches: several files of a target compile as one (CMake's unity build), because most of the time of a file goes into headers and
# templates that it shares with its neighbours. The presets release and tsan do this; docs/decisions/building.md has the reasons.
# scripts/batch_sources.py chooses files that keep their meaning in one batch.
option(DUET_BATCHES "Compile the files of a target in batches" OFF)

# Lets the sources of TARGET compile in batches, if this build has them.
function(duet_compile_in_batches target)
  set_property(GLOBAL APPEND PROPERTY DUET_BATCHED_TARGETS ${target})
endfunction()

# Runs after configuration, when targets.json is complete (DuetTargetTable.cmake).
function(duet_choose_batches)
  get_property(targets GLOBAL PROPERTY DUET_BATCHED_TARGETS)
  set(chooser ${PROJECT_SOURCE_DIR}/scripts/batch_sources.py)
  set(groups ${PROJECT_BINARY_DIR}/batches.cmake)
  execute_process(COMMAND ${DUET_PYTHON3} -B ${chooser} ${PROJECT_BINARY_DIR} ${targets}
    OUTPUT_FILE ${groups} COMMAND_ERROR_IS_FATAL ANY)
  set_target_properties(${targets} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  include(${groups})
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${chooser} ${PROJECT_SOURCE_DIR}/scripts/cpp_names.py)
endfunction()

if(DUET_BATCHES AND NOT DUET_PYTHON3)
  message(STATUS "No python3, which chooses the batches: every file compiles by itself")
elseif(DUET_BATCHES)
  cmake_language(DEFER DIRECTORY ${PROJECT_SOURCE_DIR} CALL duet_choose_batches)
endif()
