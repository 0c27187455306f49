#!/bin/bash
# instruction_sets.sh OBJDUMP LIBRARY: fails if an AVX instruction stands outside the namespaces
# N_AVX2 and N_AVX3 of the library's objects. One such copy of an inline function, kept by the
# linker, would crash every machine without AVX.
set -euo pipefail
objdump=$1 library=$2

if ! "$objdump" --file-headers "$library" | grep 'x86-64' > /dev/null; then
  echo "no x86-64 objects: nothing to look for"
  exit 0
fi
"$objdump" --disassemble --no-show-raw-insn "$library" | awk '
  /^[0-9a-f]+ <.*>:$/ { name = $2; inside = name ~ /N_AVX[23]/; next }
  # VEX and EVEX encoded instructions all begin with v in AT&T syntax; verr and verw do not count.
  /^ *[0-9a-f]+:\t/ {
    avx = ($0 ~ /%[yz]mm|%k[0-7]/) || ($2 ~ /^v/ && $2 !~ /^ver[rw]/)
    if (avx && inside) ++good
    if (avx && !inside) { print "AVX outside its namespace: " name " " $0; ++bad }
  }
  END {
    if (good < 100) { print "only " good + 0 " AVX instructions inside their namespaces: is this the right library?"; exit 1 }
    if (bad > 0) exit 1
    print good " AVX instructions, all inside their namespaces"
  }'
