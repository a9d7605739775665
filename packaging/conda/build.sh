#!/usr/bin/env bash
# Build of the conda package; conda-build sets the variables.
set -euo pipefail
cmake -S . -B build/conda -G Ninja ${CMAKE_ARGS:-} -DCMAKE_BUILD_TYPE=Release -DTALUS_TESTS=OFF -DTALUS_BENCH=OFF
cmake --build build/conda --target talus
cmake --install build/conda
