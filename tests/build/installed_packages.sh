#!/bin/bash
# On a Debian with nothing else: one line installs the packages of a folder, and the program cleans, generates and scores. So it does on the
# least processor that they are for, which QEMU plays; an older one is told. What each level of x86-64 generated goes to OUT.
# Usage, as root: installed_packages.sh PACKAGES OUT
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
packages=$(realpath "$1") out=$(realpath "$2")
cd "$(mktemp -d)"
apt-get update -qq
apt-get install -y -qq "$packages"/actformer_*.deb "$packages"/actformer-train_*.deb >/dev/null
actformer --version
actformer synth ntu -o raw --clips 12 --actions 9,10
actformer ingest ntu raw -o ntu
generate=(generate --generator weights/cmu/actformer.h5 --per-class 1 --seed 1)
for level in v2 v3 v4; do
    ACTFORMER_ISA=$level actformer "${generate[@]}" -o "$out/$level.h5" || rm -f "$out/$level.h5"
done
actformer features --recogniser weights/cmu/recogniser.h5 "$out/v2.h5" -o features.h5

apt-get install -y -qq --no-install-recommends qemu-user >/dev/null
qemu-x86_64 -cpu Nehalem "$(command -v actformer)" synth ntu -o raw-nehalem --clips 12 --actions 9,10
diff -r raw raw-nehalem
OPENBLAS_CORETYPE=Nehalem qemu-x86_64 -cpu Nehalem /usr/libexec/actformer/actformer-train "${generate[@]}" -o "$out/nehalem.h5"
said=$(qemu-x86_64 -cpu core2duo "$(command -v actformer)" --version 2>&1 || echo "exit $?")
echo "$said"
[[ $said == *"exit 1" && $(wc -l <<<"$said") = 2 ]]
