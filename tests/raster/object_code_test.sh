#!/usr/bin/env bash
# Looks at the machine code of libgnomon_raster.a for what docs/determinism.md rules out.
#   object_code_test.sh fused LIBRARY OBJDUMP      instructions that round otherwise than written
#   object_code_test.sh wide  LIBRARY OBJDUMP NM   inline functions compiled for a wide instruction
#                                                  set that the linker may keep for every caller
# Oracle: the names of x86-64's and AArch64's instructions.
set -euo pipefail

check="$1" library="$2" objdump="$3"

code() { "$objdump" --disassemble --no-show-raw-insn "$library"; }

# Prints "member function: instruction" for each instruction whose name matches. Reads what the
# disassemblers of binutils and LLVM print.
instructions() {
  awk -v pattern="^($1)" '
    /[ \t]file format / { member = $1 }
    /^[0-9a-f]+ <.*>:$/ { name = substr($2, 2, length($2) - 3) }
    /^ +[0-9a-f]+: *\t/ {
      ++seen
      split($0, part, "\t")
      if (part[2] ~ pattern) print member, name ": " part[2]
    }
    END { if (seen < 1000) print "only " seen + 0 " instructions were found in the library" }'
}

case "$check" in
  fused)
    # Multiply-add that rounds once, then estimates of 1/x and 1/sqrt(x); x86-64 before AArch64.
    found="$(code | instructions 'v?f[n]?m(add|sub)|v4f|v?rcp|v?rsqrt|fml[as]|fr(ecp|sqrt)')"
    [[ -z "$found" ]] || {
      echo "$library holds instructions that round otherwise than the source says:"
      head -20 <<<"$found"
      exit 1
    }
    ;;
  wide)
    weak="$("$4" --defined-only "$library" | awk '$2 ~ /^[WVu]$/ { print $3 }' | sort -u)"
    # Highway's own names say the instruction set; a caller compiled for another one never asks for them.
    shared="$(grep -vE 'N_[A-Z0-9_]+' <<<"$weak" || true)"
    found="$(code | instructions 'v|k(mov|test|ortest)' |
      awk 'NR == FNR { shared[$1]; next } { name = $2; sub(/:$/, "", name) } name in shared || /^only/' \
        <(echo "$shared") -)"
    [[ -z "$found" ]] || {
      echo "the linker may keep these for callers on any processor:"
      head -20 <<<"$found"
      exit 1
    }
    ;;
  *)
    echo "there is no check '$check'" >&2
    exit 2
    ;;
esac
