# The interpreter that runs scripts.

# The distribution's own interpreter comes first: it is the one that sees python3-grpcio.
find_program(DUET_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(DUET_BUILD_TESTS)
  find_program(DUET_PYTHON3 python3 REQUIRED)
endif()
