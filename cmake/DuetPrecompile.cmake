# Precompiled headers: most of the time that a file takes to compile goes into headers of libraries
# (LibTorch's take ten seconds). Every file pays for reading its whole set, so a set has only what most
# files include; JSON would more than double the time of a file that does not use it. Only the presets
# release and tsan use them. The other builds show that every file includes what it uses.
option(DUET_PRECOMPILE "Precompile the headers of libraries that most files include" OFF)

# Makes duet_precompiled_<NAME>: HEADERS, compiled as a target with the same OPTIONS and LINKS sees them.
function(duet_precompiled_headers)
  cmake_parse_arguments(A "PROGRAM" "NAME" "HEADERS;LINKS;OPTIONS" ${ARGN})
  set(target duet_precompiled_${A_NAME})
  set(source ${PROJECT_BINARY_DIR}/generated/${target}.cc)
  file(CONFIGURE OUTPUT ${source} CONTENT "int main() { return 0; }\n")
  if(A_PROGRAM)  # Programs and libraries differ in their position-independent code.
    add_executable(${target} EXCLUDE_FROM_ALL ${source})
    set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/precompiled)
  else()
    add_library(${target} OBJECT EXCLUDE_FROM_ALL ${source})
  endif()
  target_link_libraries(${target} PRIVATE ${A_LINKS})
  duet_enable_warnings(${target})  # -Wpedantic predefines fewer macros, and those must agree.
  target_compile_options(${target} PRIVATE ${A_OPTIONS})
  target_precompile_headers(${target} PRIVATE ${A_HEADERS})
  if(DUET_CCACHE)
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  endif()
endfunction()

# Lets TARGET use the precompiled headers of that name, if this build has them and the name is not empty. Targets that link LibTorch
# without including it use "none": LibTorch's options define macros that the other headers lack.
function(duet_precompile target name)
  if(name AND TARGET duet_precompiled_${name})
    target_precompile_headers(${target} REUSE_FROM duet_precompiled_${name})
    # GCC 12 no longer sees that these false alarms come from the standard library's headers.
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict
                                             -Wno-stringop-overflow -Wno-stringop-overread)
    if(DUET_CCACHE)
      target_compile_options(${target} PRIVATE -fpch-preprocess)
    endif()
  endif()
endfunction()

if(DUET_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # It predefines a macro, in which all targets must agree.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-pthread>)
  # GCC collects garbage from 128 MB on, which takes a sixth of the time of a file of ours. From 400 MB on, a batch takes up to 850 MB
  # instead of 700, and one with LibTorch 1.2 GB as before.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=400000>)
  set(library_headers <algorithm> <cstdint> <functional> <memory> <optional> <string> <string_view>
      <utility> <vector> <absl/status/status.h> <absl/status/statusor.h> <absl/strings/str_cat.h>
      <absl/strings/str_format.h> <absl/types/span.h>)
  set(test_headers ${library_headers} <gmock/gmock.h> <gtest/gtest.h>)
  set(library_links absl::span absl::status absl::statusor absl::str_format absl::strings)
  set(test_options -O0 $<$<CONFIG:Release>:-U_FORTIFY_SOURCE>)
  duet_precompiled_headers(NAME library HEADERS ${library_headers} LINKS ${library_links})
  duet_precompiled_headers(NAME glue HEADERS ${library_headers} LINKS ${library_links}
    OPTIONS ${DUET_GLUE_OPTIONS})
  if(TARGET duet::torch)
    duet_precompiled_headers(NAME torch HEADERS ${library_headers} <torch/torch.h>
      LINKS ${library_links} duet::torch)
  endif()
  if(TARGET GTest::gmock)
    duet_precompiled_headers(NAME test PROGRAM HEADERS ${test_headers} OPTIONS ${test_options}
      LINKS ${library_links} GTest::gmock)
  endif()
  if(TARGET GTest::gmock AND TARGET duet::torch)
    duet_precompiled_headers(NAME torch_test PROGRAM HEADERS ${test_headers} <torch/torch.h>
      OPTIONS ${test_options} LINKS ${library_links} duet::torch GTest::gmock)
  endif()
endif()
