#!/usr/bin/env python3
"""Prints the test programs that do not link LibTorch, one in each line.

    scripts/torch_free_tests.py BUILD_FOLDER [LABEL]     LABEL: only programs with this CTest label
"""

import sys

import build_tree

if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    print("\n".join(build_tree.torch_free_tests(*sys.argv[1:])))
