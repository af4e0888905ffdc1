# Enables the project's warnings; errors with DUET_WARNINGS_AS_ERRORS (on in CI and in the dev preset).
function(duet_enable_warnings target)
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
      -Woverloaded-virtual -Wcast-qual -Wundef -Wunused -Wformat=2 -Wimplicit-fallthrough
      $<$<CXX_COMPILER_ID:Clang>:-Wthread-safety>
      $<$<BOOL:${DUET_WARNINGS_AS_ERRORS}>:-Werror>>)
endfunction()
