# Protections that stay on in release builds: an out-of-range index or an erased end() aborts the process
# instead of corrupting it, and an orchestrator restarts it.
# scripts/check_hardening.sh checks that the programs have them (docs/security.md).
#
# These options are global, so that no target and no generated file is left out.
option(DUET_HARDENING "Keep the library's assertions and the compiler's and linker's protections" ON)

if(DUET_HARDENING)
  add_compile_definitions($<$<COMPILE_LANGUAGE:CXX>:_GLIBCXX_ASSERTIONS>)
  add_compile_options(
    $<$<COMPILE_LANGUAGE:C,CXX>:-fstack-protector-strong>
    # Fortified functions need an optimising build; sanitizers replace them in the others.
    "$<$<AND:$<COMPILE_LANGUAGE:C,CXX>,$<CONFIG:Release>>:SHELL:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    add_compile_options($<$<COMPILE_LANGUAGE:C,CXX>:-fcf-protection>)
  endif()
  add_link_options(-Wl,-z,relro -Wl,-z,now)
endif()
