# The interpreter that runs scripts, and the extension module of the Python package (client/python/extension).

# The distribution's own interpreter comes first: it is the one that sees python3-grpcio.
find_program(DUET_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(DUET_BUILD_TESTS)
  find_program(DUET_PYTHON3 python3 REQUIRED)
endif()

set(DUET_PYTHON_EXTENSION AUTO CACHE STRING
    "Build the extension module that reads motion files in Python: ON, OFF, or AUTO (if its headers are found)")
set_property(CACHE DUET_PYTHON_EXTENSION PROPERTY STRINGS AUTO ON OFF)

# DUET_BUILD_PYTHON_EXTENSION: whether to build it.
set(DUET_BUILD_PYTHON_EXTENSION OFF)
if(DUET_PYTHON_EXTENSION AND DUET_PYTHON3)
  set(Python3_EXECUTABLE ${DUET_PYTHON3})
  find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
  set(PYBIND11_NOPYTHON ON)  # only its headers: FindPython3 has found the rest
  find_package(pybind11 2.10 CONFIG QUIET)
  if(Python3_Development.Module_FOUND AND pybind11_FOUND)
    set(DUET_BUILD_PYTHON_EXTENSION ON)
  endif()
endif()
if(DUET_PYTHON_EXTENSION AND NOT DUET_PYTHON_EXTENSION STREQUAL AUTO AND NOT DUET_BUILD_PYTHON_EXTENSION)
  message(FATAL_ERROR "DUET_PYTHON_EXTENSION: expected the headers of pybind11 2.10 and of Python for ON, got "
                      "none; install pybind11-dev and libpython3-dev, or set it to OFF")
endif()

# duet_python_module(NAME duet_x MODULE _x PACKAGE package SOURCES a.cc DEPS duet::y)
# Makes the module <build>/python/<PACKAGE>/_x.<ABI>.so. It contains the project's libraries and exports only its
# initialisation. Abseil stays shared, because Debian's archives of it cannot become part of a shared library;
# the module looks for it in the folder _libs beside itself first, where scripts/build_python.sh puts it in wheels.
function(duet_python_module)
  cmake_parse_arguments(A "" "NAME;MODULE;PACKAGE" "SOURCES;DEPS" ${ARGN})
  Python3_add_library(${A_NAME} MODULE WITH_SOABI ${A_SOURCES})
  set_target_properties(${A_NAME} PROPERTIES
    OUTPUT_NAME ${A_MODULE}
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python/${A_PACKAGE}
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    BUILD_RPATH $ORIGIN/_libs)
  target_include_directories(${A_NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${A_NAME} PRIVATE ${A_DEPS} pybind11::headers)
  # The libraries in _libs find each other by the module's RPATH; a RUNPATH would be for the module's own needs.
  target_link_options(${A_NAME} PRIVATE -Wl,--exclude-libs,ALL -Wl,--disable-new-dtags $<$<CONFIG:Release>:-s>)
  duet_enable_warnings(${A_NAME})
  duet_link_fast(${A_NAME})
endfunction()
