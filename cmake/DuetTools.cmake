# Tools for the build: a table of the targets for the scripts; ccache and mold if they are installed.
include(DuetTargetTable)

find_program(DUET_CCACHE ccache)
mark_as_advanced(DUET_CCACHE)
if(DUET_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Without these ccache passes on files that use precompiled headers (DuetPrecompile.cmake).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${DUET_CCACHE})
endif()

find_program(DUET_MOLD mold)
mark_as_advanced(DUET_MOLD)

# Links a program with mold: a LibTorch program has 339 libraries to resolve.
function(duet_link_fast target)
  if(DUET_MOLD)
    target_link_options(${target} PRIVATE -fuse-ld=mold)
  endif()
endfunction()

# Compiles what lies in a folder tests without optimisation: it is run, not shipped. With optimisation it takes a fifth
# of the time of a whole build, and under a sanitizer twice as long.
function(duet_compile_fast target)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR}
             OUTPUT_VARIABLE folder)
  if(folder MATCHES "^(.*/)?tests(/|$)")
    # Fortified functions warn without optimisation.
    target_compile_options(${target} PRIVATE -O0 $<$<CONFIG:Release>:-U_FORTIFY_SOURCE>)
  endif()
endfunction()
