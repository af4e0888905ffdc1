# Functions for every target of the project: explicit sources, aliases, no global flags.
# Code that is not worth optimising further (GLUE below): flags, settings, reports, main functions.
set(DUET_GLUE_OPTIONS $<$<CONFIG:Release>:-O1>)

include(DuetWarnings)
include(DuetTools)
include(DuetPrecompile)

# duet_library(NAME motion SOURCES a.cc b.cc [DEPS duet::x absl::y] [PRIVATE_DEPS ...] [PRECOMPILED torch] [GLUE] [SINGLY])
# Makes duet_<name> with the alias duet::<name>; headers are included from the top folder.
# GLUE: nothing in it is computed often, such as flags and reports, so that it is compiled in less time.
# SINGLY: its files never compile in batches.
function(duet_library)
  cmake_parse_arguments(A "GLUE;SINGLY" "NAME;PRECOMPILED" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(duet_${A_NAME} STATIC ${A_SOURCES})
  add_library(duet::${A_NAME} ALIAS duet_${A_NAME})
  target_include_directories(duet_${A_NAME} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(duet_${A_NAME} PUBLIC ${A_DEPS} PRIVATE ${A_PRIVATE_DEPS})
  duet_enable_warnings(duet_${A_NAME})
  duet_compile_fast(duet_${A_NAME})
  if(A_GLUE)
    target_compile_options(duet_${A_NAME} PRIVATE ${DUET_GLUE_OPTIONS})
  endif()
  if(NOT A_PRECOMPILED AND NOT CMAKE_CURRENT_SOURCE_DIR MATCHES "^${PROJECT_SOURCE_DIR}/(.*/)?tests(/|$)")
    set(A_PRECOMPILED library)
    if(A_GLUE)
      set(A_PRECOMPILED glue)
    endif()
  endif()
  duet_precompile(duet_${A_NAME} "${A_PRECOMPILED}")
  if(NOT A_SINGLY)
    duet_compile_in_batches(duet_${A_NAME})
  endif()
endfunction()

# duet_program(NAME duet-server SOURCES main.cc DEPS ...): an executable in <build>/bin. Its own sources are glue.
function(duet_program)
  cmake_parse_arguments(A "" "NAME" "SOURCES;DEPS" ${ARGN})
  add_executable(${A_NAME} ${A_SOURCES})
  target_link_libraries(${A_NAME} PRIVATE ${A_DEPS})
  target_include_directories(${A_NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_options(${A_NAME} PRIVATE ${DUET_GLUE_OPTIONS})
  duet_enable_warnings(${A_NAME})
  duet_compile_fast(${A_NAME})
  duet_link_fast(${A_NAME})
endfunction()

# duet_share_cores(name waits): how many half cores a test takes. A test that mostly waits, for timeouts and processes, runs beside
# others: scripts/check.py runs tests on six half cores.
function(duet_share_cores name waits)
  if(waits)
    set_tests_properties(${name} PROPERTIES PROCESSORS 1)
  else()
    set_tests_properties(${name} PROPERTIES PROCESSORS 2)
  endif()
endfunction()

# duet_test(NAME motion_test SOURCES a_test.cc DEPS ... [LABELS ...] [ENVIRONMENT ...] [TIMEOUT s]
#           [PRECOMPILED torch_test] [WAITS])
# One CTest entry for each test program, linked with GoogleTest's main and mocks.
function(duet_test)
  cmake_parse_arguments(A "WAITS" "NAME;TIMEOUT;PRECOMPILED" "SOURCES;DEPS;LABELS;ENVIRONMENT" ${ARGN})
  add_executable(${A_NAME} ${A_SOURCES})
  target_link_libraries(${A_NAME} PRIVATE ${A_DEPS} GTest::gmock GTest::gtest_main)
  duet_compile_fast(${A_NAME})
  if(NOT A_PRECOMPILED)
    set(A_PRECOMPILED test)
  endif()
  duet_precompile(${A_NAME} ${A_PRECOMPILED})
  duet_compile_in_batches(${A_NAME})
  target_include_directories(${A_NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  set_target_properties(${A_NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  duet_enable_warnings(${A_NAME})
  duet_link_fast(${A_NAME})
  add_test(NAME ${A_NAME} COMMAND ${A_NAME})
  duet_share_cores(${A_NAME} ${A_WAITS})
  if(NOT A_TIMEOUT)
    set(A_TIMEOUT 300)
  endif()
  set_tests_properties(${A_NAME} PROPERTIES TIMEOUT ${A_TIMEOUT} LABELS "${A_LABELS}"
    ENVIRONMENT "DUET_SOURCE_DIR=${PROJECT_SOURCE_DIR};DUET_BIN_DIR=${CMAKE_BINARY_DIR}/bin;OMP_NUM_THREADS=1;${A_ENVIRONMENT}")
endfunction()

# duet_script_test(NAME viewer_test [ARGUMENTS ...] [LIBTORCH] [WAITS]): runs <NAME>.py. LIBTORCH: the script needs
# programs that link LibTorch, which scripts/sanitize.sh and builds without training do not build. WAITS: see duet_share_cores.
# A script that starts a server has the label "server". Scripts import the helpers of tests/e2e.
function(duet_script_test)
  cmake_parse_arguments(A "LIBTORCH;WAITS" "NAME" "ARGUMENTS" ${ARGN})
  if(A_LIBTORCH AND NOT DUET_TRAINING)
    return()
  endif()
  add_test(NAME ${A_NAME}
    COMMAND ${DUET_PYTHON3} -B ${CMAKE_CURRENT_SOURCE_DIR}/${A_NAME}.py ${A_ARGUMENTS})
  duet_share_cores(${A_NAME} ${A_WAITS})
  set(labels e2e)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${A_NAME}.py)
  file(STRINGS ${A_NAME}.py starts
       REGEX "tools\\.(Server\\(|running_server\\(|ServedTest)|(Studio|Page|Gateway|Guide)Test\\)|LoggingServer\\(|(wire|live)_fuzzer")
  if(starts)
    list(APPEND labels server)
  endif()
  if(A_LIBTORCH)
    list(APPEND labels libtorch)
  endif()
  set_tests_properties(${A_NAME} PROPERTIES TIMEOUT 900 LABELS "${labels}" SKIP_RETURN_CODE 77
    ENVIRONMENT "DUET_SOURCE_DIR=${PROJECT_SOURCE_DIR};DUET_BIN_DIR=${CMAKE_BINARY_DIR}/bin;PYTHONPATH=${PROJECT_SOURCE_DIR}/tests/e2e")
endfunction()

# duet_manual_page(program section component summary [command]): installs a manual page, which is the program's help.
find_program(HELP2MAN help2man)
mark_as_advanced(HELP2MAN)
function(duet_manual_page program section component summary)
  if(NOT HELP2MAN OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  list(JOIN ARGN "" command)
  string(JOIN "-" name ${program} ${command})
  set(page ${CMAKE_CURRENT_BINARY_DIR}/${name}.${section})
  add_custom_command(OUTPUT ${page}
    COMMAND ${HELP2MAN} --no-info --section=${section} "--version-string=${name} ${PROJECT_VERSION}"
            "--name=${summary}" --output=${page} "$<TARGET_FILE:${program}> ${command}"
    DEPENDS ${program} VERBATIM)
  add_custom_target(duet_page_${name} ALL DEPENDS ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT ${component})
endfunction()

# duet_embed_file(TARGET symbol path...): links the bytes of a file, or of several one after the other, into TARGET as
#   extern "C" const unsigned char <symbol>[], <symbol>_end[];
function(duet_embed_file target symbol)
  list(TRANSFORM ARGN REPLACE "(.+)" "    .incbin \"\\1\"\n" OUTPUT_VARIABLE content)
  list(JOIN content "" content)
  set(stub ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.S)
  file(WRITE ${stub}.in
"    .section .rodata
    .global ${symbol}, ${symbol}_end
    .balign 64
${symbol}:
${content}${symbol}_end:
    .byte 0
    .section .note.GNU-stack,\"\",@progbits
")
  configure_file(${stub}.in ${stub} COPYONLY)
  set_source_files_properties(${stub} PROPERTIES OBJECT_DEPENDS "${ARGN}")
  target_sources(${target} PRIVATE ${stub})
endfunction()
