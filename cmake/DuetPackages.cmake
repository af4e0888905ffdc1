# Finds all packages of the distribution that Duet uses.

# Debian ships no ProtobufConfig.cmake, so this uses module mode, before gRPC looks for the package.
find_package(Protobuf REQUIRED)
find_package(Threads REQUIRED)
find_package(absl CONFIG REQUIRED)
find_package(gRPC CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(Eigen3 3.4 CONFIG REQUIRED)

if(NOT DUET_CLIENT_ONLY)
  find_package(HWY CONFIG REQUIRED)
  find_package(prometheus-cpp CONFIG REQUIRED)
  find_library(DUET_LIBEVENT event REQUIRED)  # Debian ships no LibeventConfig.cmake
  if(DUET_BUILD_TESTS)
    find_package(GTest CONFIG REQUIRED)
  endif()
  if(DUET_BUILD_BENCHMARKS)
    find_package(benchmark CONFIG REQUIRED)
  endif()
endif()

if(DUET_TRAINING)
  find_package(Torch CONFIG)
  if(NOT Torch_FOUND)
    message(FATAL_ERROR "DUET_TRAINING: expected LibTorch (libtorch-dev), got none; set DUET_TRAINING=OFF "
                        "to build the server and the clients without training")
  endif()
  # LibTorch uses any installed libblas. The reference implementation is 30 to 60 times slower, so
  # OpenBLAS is linked by name.
  find_library(DUET_OPENBLAS openblas PATH_SUFFIXES openblas-openmp REQUIRED)

  # LibTorch's headers, only for the few targets that need them.
  add_library(duet_torch INTERFACE)
  add_library(duet::torch ALIAS duet_torch)
  target_link_libraries(duet_torch INTERFACE ${DUET_OPENBLAS} ${TORCH_LIBRARIES})
  target_include_directories(duet_torch SYSTEM INTERFACE ${TORCH_INCLUDE_DIRS})
endif()
