#!/usr/bin/env bash
# ./meca install: what the build and the tests need, from Debian's packages.
. scripts/common.sh
need build ethercat
