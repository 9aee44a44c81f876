#!/usr/bin/env bash
# The program runs on the machine it was built for: AVX (instructions v... on vector registers) is used only in the loops that lib/batch/isa_loops.h
# marks for it (functions kernel_avx..., and all of the namespaces avx2 and avx512), which are called after asking the processor.
set -euo pipefail
if ! command -v objdump >/dev/null || [ "$(uname -m)" != x86_64 ]; then echo "skipped: no objdump, or not x86-64"; exit 0; fi
if grep -qE '^CMAKE_CXX_FLAGS[A-Z_]*:.*-m(arch|avx)' "$ISOPARM_BUILD_DIR/CMakeCache.txt"; then echo "skipped: built for a newer machine"; exit 0; fi
found=$(objdump -d --no-show-raw-insn "$ISOPARM_PROGRAM" | awk '/^[0-9a-f]+ </ { name = $2 } /\tv[a-z0-9]+ .*%[xyz]mm/ { count[name]++ } END { for (n in count) print n }')
grep -q kernel_avx2 <<<"$found" || { echo "no loop for AVX2 was found: this test sees nothing"; exit 1; }
if grep -v 'kernel_avx\(2\|512\)\|4avx2\|6avx512' <<<"$found"; then echo "the functions above use AVX on every machine"; exit 1; fi
echo "AVX only in $(wc -l <<<"$found") loops of their own"
