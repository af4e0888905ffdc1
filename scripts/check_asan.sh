#!/usr/bin/env bash
# AddressSanitizer and UndefinedBehaviorSanitizer over every test program that needs no LibTorch, and
# over every script that starts a server.
exec "$(dirname "${BASH_SOURCE[0]}")/sanitize.sh" asan
