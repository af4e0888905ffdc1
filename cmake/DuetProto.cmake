# duet_proto_library(NAME proto IMPORT_DIR dir PROTOS a/b.proto ... [GRPC c/d.proto ...] [GLUE])
# Generates C++ for every proto, and gRPC stubs (with mocks) for those in GRPC. The target
# duet_generated makes all of them, which is enough for checks that only read the sources. GLUE: as in duet_library.
function(duet_proto_library)
  cmake_parse_arguments(A "GLUE" "NAME;IMPORT_DIR" "PROTOS;GRPC" ${ARGN})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/gen)
  file(MAKE_DIRECTORY ${out})
  set(sources "")
  foreach(proto IN LISTS A_PROTOS A_GRPC)
    string(REGEX REPLACE "\\.proto$" "" stem ${proto})
    set(generated ${out}/${stem}.pb.cc ${out}/${stem}.pb.h)
    set(grpc_arguments "")
    if(proto IN_LIST A_GRPC)
      # First: Ninja expects the order of protoc's dependency file, which is alphabetical.
      list(PREPEND generated ${out}/${stem}.grpc.pb.cc ${out}/${stem}.grpc.pb.h)
      set(grpc_arguments --grpc_out=${out}
          --plugin=protoc-gen-grpc=$<TARGET_FILE:gRPC::grpc_cpp_plugin>)
    endif()
    add_custom_command(OUTPUT ${generated}
      COMMAND protobuf::protoc -I ${A_IMPORT_DIR} --cpp_out=${out} ${grpc_arguments}
              --dependency_out=${out}/${stem}.d ${proto}
      DEPENDS ${A_IMPORT_DIR}/${proto} protobuf::protoc
      DEPFILE ${out}/${stem}.d  # imported protos
      VERBATIM)
    list(APPEND sources ${generated})
  endforeach()
  add_library(duet_${A_NAME} STATIC ${sources})
  add_library(duet::${A_NAME} ALIAS duet_${A_NAME})
  target_include_directories(duet_${A_NAME} SYSTEM PUBLIC
    $<BUILD_INTERFACE:${out}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(duet_${A_NAME} PUBLIC $<$<BOOL:${A_GRPC}>:gRPC::grpc++> protobuf::libprotobuf)
  if(A_GLUE)
    target_compile_options(duet_${A_NAME} PRIVATE ${DUET_GLUE_OPTIONS})
  endif()
  if(NOT TARGET duet_generated)
    add_custom_target(duet_generated)
  endif()
  add_dependencies(duet_generated duet_${A_NAME})
endfunction()
