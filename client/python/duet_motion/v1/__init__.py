"""Made from the proto files: scripts/python_stubs.sh."""
