#!/usr/bin/env bash
# Runs every test program that needs no LibTorch, and every script that starts a server, under
# AddressSanitizer and UndefinedBehaviorSanitizer.
exec "$(dirname "${BASH_SOURCE[0]}")/sanitize.sh" asan
