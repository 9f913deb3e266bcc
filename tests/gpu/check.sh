#!/usr/bin/env bash
# What only a machine with an NVIDIA GPU can tell, in one run that needs no network there. What that machine has: CUDA, PyTorch, g++, CMake, ninja.
#
#   pack     here, on a Debian: the packages that it lacks, into $PACKAGES
#   unpack   there, as all that follows: the packages into $WORK/prefix, nothing outside it
#   build    the program and its kernels' tests against PyTorch's libtorch, into $BUILD
#   check    the kernels' tests, features, trainings, PyTorch beside them, CUDA's tests: $OUT/figures.json
#   cuda     of these CUDA's tests alone, built before they run
#   all      unpack, build and check; exit code 1 where a step of them failed
#   list     the steps of check, without running them
#
# A step that fails or takes too long is in figures.json with its exit code, and the next one goes on. Without CUDA, or with CUDA_DEVICE=cpu, all is
# rehearsed on the processor, with small sizes.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."

PACKAGES=${PACKAGES:-.gpu}
WORK=$(realpath -m "${WORK:-build-gpu}")
OUT=$(realpath -m "${OUT:-$WORK}")
PYTHON=${PYTHON:-python3}             # has torch, and h5py and NumPy to compare features
PEERS=${PEERS:-../shared/reference}   # holds actformer_speed.py and stgcn.py, to be compared with
STEP=${STEP:-}                        # seconds of the full-size training: 300, in a rehearsal 10
ONLY=${ONLY:-}                        # of check's steps those whose names match, as in 'synth|ingest|train-.*'; list names them
prefix=$WORK/prefix logs=$WORK/logs run=$WORK/run
own_build=${BUILD:+no}                # BUILD: a build that is there already
BUILD=$(realpath -m "${BUILD:-$WORK/build}")

packages=(
    pkgconf-bin ocl-icd-opencl-dev opencl-clhpp-headers libhdf5-dev libarchive-dev zlib1g-dev libxxhash-dev libfmt-dev libyaml-cpp-dev
    libcli11-dev nlohmann-json3-dev libeigen3-dev libboost-dev libgtest-dev libbenchmark-dev
)
# Whatever compiles programs has these; or the program needs nothing of them.
not_packed='^(libc6.*|libc-dev|libgcc.*|libstdc\+\+.*|gcc.*|g\+\+.*|cpp.*|libgfortran.*|libquadmath.*|dpkg.*|debconf.*|perl.*|pkg-config|pkgconf'
not_packed+='|libssl-dev|libjpeg.*|hdf5-helpers|libhdf5-(hl|cpp|fortran).*|libsasl2-modules.*|libdb5.*|.*-doc)$'

say() { printf '== %s\n' "$*"; }

pack() {
    local wave=("${packages[@]}")
    local -A taken=()
    while ((${#wave[@]})); do
        for name in "${wave[@]}"; do taken[$name]=1; done
        mapfile -t wave < <(LC_ALL=C apt-cache depends --no-{recommends,suggests,conflicts,breaks,replaces,enhances} "${wave[@]}" |
            sed -nE 's/^ *\|?(Pre)?Depends: ([^<]+)$/\2/p' | sort -u | grep -vE "$not_packed" |
            while read -r name; do [ -n "${taken[$name]:-}" ] || echo "$name"; done)
    done
    mkdir -p "$PACKAGES"
    (cd "$PACKAGES" && apt-get download -qq "${!taken[@]}")
    say "${#taken[@]} packages, $(du -sh "$PACKAGES" | cut -f1), in $PACKAGES"
}

unpack() {
    local debs=("$PACKAGES"/*.deb) link libs
    [ -e "${debs[0]}" ] || { echo "check.sh: no packages in $PACKAGES: pack them where there is a Debian" >&2; exit 1; }
    rm -rf "$prefix"
    mkdir -p "$prefix"
    for deb in "${debs[@]}"; do dpkg -x "$deb" "$prefix"; done
    # Links to files of the root are to those of the prefix; and what a package does when it is installed: a name for HDF5's .pc file.
    find "$prefix" -lname '/*' | while read -r link; do ln -sfn "$prefix$(readlink "$link")" "$link"; done
    libs=$(echo "$prefix"/usr/lib/*-linux-gnu)
    ln -sfn hdf5-serial.pc "$libs/pkgconfig/hdf5.pc"
    cat >"$prefix/pkg-config" <<PKG_CONFIG
#!/bin/sh
LD_LIBRARY_PATH=$libs PKG_CONFIG_SYSROOT_DIR=$prefix PKG_CONFIG_LIBDIR=$libs/pkgconfig:$prefix/usr/share/pkgconfig exec $prefix/usr/bin/pkgconf "\$@"
PKG_CONFIG
    chmod +x "$prefix/pkg-config"
    say "${#debs[@]} packages, in $prefix"
}

# Programs find the prefix's libraries, and CUDA's beside PyTorch, by the path that they are linked with; so does the linker.
build() {
    [ "$own_build" != no ] || { say "taken as it is: $BUILD"; return; }
    local site path flags
    site=$("$PYTHON" -c 'import os, torch; print(os.path.dirname(os.path.dirname(torch.__file__)))')
    path=$(printf '%s:' "$prefix"/{usr/,}lib/*-linux-gnu "$site/torch/lib" "$site"/nvidia/*/lib)
    flags="-Wl,--disable-new-dtags,-rpath,${path%:}"
    mkdir -p "$logs"
    # The architectures: so that CMake asks no GPU for its own. nvcc compiles nothing here. The policy: CMake 4 refuses packages of older times.
    cmake -S . -B "$BUILD" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPKG_CONFIG_EXECUTABLE="$prefix/pkg-config" \
        -DCMAKE_PREFIX_PATH="$prefix/usr;$("$PYTHON" -c 'import torch; print(torch.utils.cmake_prefix_path)')" \
        -DCMAKE_{EXE,SHARED,MODULE}_LINKER_FLAGS="$flags" -DCMAKE_POLICY_VERSION_MINIMUM=3.5 -DTORCH_CUDA_ARCH_LIST=9.0 -DCMAKE_CUDA_ARCHITECTURES=90 \
        >"$logs/configure.log" 2>&1 || { tail -n 30 "$logs/configure.log" >&2; return 1; }
    grep -E 'without|ACTFORMER_HAS' "$logs/configure.log" || true
    ninja -C "$BUILD" -k 0 -j "$(nproc)" actformer test_kernels >"$logs/ninja.log" 2>&1 || { grep -E -m 30 'error|undefined' "$logs/ninja.log" >&2; return 1; }
    [ -x "$BUILD/actformer-train" ] || { echo "check.sh: CMake found no libtorch; see $logs/configure.log" >&2; return 1; }
    say "built: $BUILD/actformer"
}

# The model's tests that need CUDA. Without it they skip themselves, and here that is a failure: nothing would have been tested.
cuda() {
    mkdir -p "$logs"
    [ "$own_build" = no ] || ninja -C "$BUILD" -j "$(nproc)" test_model >"$logs/ninja-cuda.log" 2>&1 ||
        { grep -E -m 30 'error|undefined' "$logs/ninja-cuda.log" >&2; return 1; }
    "$BUILD/test_model" --gtest_filter='CudaGraph.*:WeightStore.*' --gtest_output="json:$logs/cuda.json" | tee "$logs/cuda.log"
    if grep -F '[  SKIPPED ]' "$logs/cuda.log" >&2; then echo "check.sh: tests of CUDA skipped themselves" >&2; return 1; fi
    grep -qE '\[  PASSED  \] [1-9]' "$logs/cuda.log" || { echo "check.sh: no test of CUDA ran" >&2; return 1; }
}

# Runs a command for so many seconds at most. Exit code `fine` is a success too. Of a crash, a debugger that is there says where it was.
step() { # name seconds command...
    local name=$1 limit=$2 from=$EPOCHREALTIME said debugger
    shift 2
    code=0
    [[ -z $ONLY || $name =~ ^($ONLY|unpack|build|version|devices)$ ]] || return 0
    if [ "$listing" = yes ]; then printf '%-32s %5s s  %s\n' "$name" "$limit" "$*"; return; fi
    timeout --kill-after=20 "$limit" "$@" >"$logs/$name.out" 2>"$logs/$name.err" || code=$?
    [ "$code" != "${fine:-0}" ] || code=0
    said=$([ "$code" = 0 ] || cat "$logs/$name.out" "$logs/$name.err" | tr '\r\t' '\n ' | grep . | tail -n 1 || true)
    if [ "$code" = 139 ] && debugger=$(command -v gdb || command -v cuda-gdb); then
        timeout --kill-after=5 60 "$debugger" -batch -ex run -ex 'bt 25' --args "$@" >"$logs/$name.backtrace" 2>&1 || true
    fi
    printf '%s\t%s\t%s\t%s\n' "$name" "$code" "$(awk "BEGIN { printf \"%.1f\", $EPOCHREALTIME - $from }")" "$said" | tee -a "$logs/steps.tsv" | cut -c1-150
    "$PYTHON" "$here/figures.py" write "$logs" "$run" "$device" >"$OUT/figures.json"  # of what was measured until now
}

# A line of each OpenCL device's kind: gpu, cpu. NVIDIA's driver may lie where no file tells of it.
find_opencl() {
    local nvidia
    if [ -z "${OCL_ICD_VENDORS:-}" ]; then
        export OCL_ICD_VENDORS=$WORK/vendors
        mkdir -p "$OCL_ICD_VENDORS"
        cp /etc/OpenCL/vendors/*.icd "$OCL_ICD_VENDORS/" 2>/dev/null || true
        nvidia=$(find /usr/local/nvidia /usr/lib /usr/lib64 -name libnvidia-opencl.so.1 2>/dev/null | head -n 1 || true)
        [ -z "$nvidia" ] || echo "$nvidia" >"$OCL_ICD_VENDORS/nvidia.icd"
    fi
    step version 60 "$program" --version
    step devices 60 "$program" devices --json
    mapfile -t kinds < <(sed -nE 's/^ *"type": "(GPU|CPU)",/\L\1/p' "$logs/devices.out" | sort -ru)
    if [ ! -x "$program" ]; then
        say "no program: there is no $program"
    elif ((${#kinds[@]} == 0)); then
        say "no OpenCL driver: kernels, features and trainings are left out"
    fi
}

# Kernels, features and trainings: all that needs OpenCL.
check_program() {
    local kind precision graphs features=()
    local train=("$program" train generator -c model/configs/actformer-ntu-2p.yaml --data "$run/ntu/ntu-2p" device="$device" batch="$batch")
    local -A bf16=([float32]=false [bf16]=true)
    for kind in "${kinds[@]}"; do
        step "kernels-$kind" 240 env ACTFORMER_DEVICE="$kind" "$BUILD/test_kernels" --gtest_brief=1 --gtest_output="json:$logs/kernels-$kind.json"
        step "features-$kind" 120 "$program" bench features --device "$kind" --batch "$feature_batch" --json
    done

    step synth 120 "$program" synth ntu -o "$run/raw" --clips "$clips" --actions 50-60,106-120
    step ingest 120 "$program" ingest ntu "$run/raw" -o "$run/ntu"
    # A training opens OpenCL beside libtorch. Where another driver than the GPU's does not bear that, what follows goes without it.
    step train-first 120 "${train[@]}" -o "$run/first" epochs=1
    if [ "$code" != 0 ] && [ "$OCL_ICD_VENDORS" = "$WORK/vendors" ] && [ -e "$WORK/vendors/nvidia.icd" ]; then
        find "$WORK/vendors" -name '*.icd' ! -name nvidia.icd -delete
        kinds=(gpu)
        step train-first-without-other-drivers 120 "${train[@]}" -o "$run/first-without-other-drivers" epochs=1
    fi
    for precision in "${precisions[@]}"; do
        for graphs in "${graphs_on[@]}"; do
            step "bench-train-$precision-graphs-$graphs" 120 "$program" bench train --method actformer --persons 2 --classes 26 --batch "$batch" \
                --rounds "$rounds" --threads "$(nproc)" --json device="$device" bf16="${bf16[$precision]}" cuda_graphs="$graphs" discriminator_steps=4
        done
    done
    for graphs in "${graphs_on[@]}"; do
        step "bench-train-csgn-graphs-$graphs" 120 "$program" bench train --method csgn --persons 2 --classes 26 --batch "$batch" \
            --rounds "$rounds" --threads "$(nproc)" --json device="$device" cuda_graphs="$graphs"
    done
    # Captured as graphs and launched kernel by kernel, passes give the same bits; and a group of processes may be one.
    for graphs in true false; do
        step "train-graphs-$graphs" 120 "${train[@]}" -o "$run/graphs-$graphs" deterministic=true cuda_graphs="$graphs" epochs="$few"
    done
    [ "$device" = cpu ] || step same-losses 60 "$PYTHON" "$here/figures.py" same "$run"/graphs-{true,false}/log.jsonl
    step train-data-parallel 120 env RANK=0 WORLD_SIZE=1 LOCAL_RANK=0 MASTER_ADDR=127.0.0.1 MASTER_PORT=29517 \
        "${train[@]}" -o "$run/data-parallel" --data-parallel epochs="$few"
    # Stopped as by any SIGTERM, it keeps where it is.
    fine=143 step train-full-size $((STEP + 60)) timeout --preserve-status "$STEP" "${train[@]}" -o "$run/full-size" \
        checkpoint_minutes=60 epochs=1000000 bf16="${bf16[${precisions[-1]}]}"

    # What the GPU trained and generated, through the recogniser in OpenCL on each device and in PyTorch on the processor.
    step recogniser 240 "$program" train recogniser -c model/configs/recogniser-ntu-2p.yaml --data "$run/ntu/ntu-2p" -o "$run/recogniser" \
        device="$device" epochs=2 batch="$batch"
    step generate 120 "$program" generate --generator "$run/full-size" -o "$run/made.h5" --per-class 4 --device "$device" --force
    for kind in "${kinds[@]}"; do
        step "made-features-$kind" 120 "$program" features --recogniser "$run/recogniser/weights-last.h5" "$run/made.h5" -o "$run/$kind.h5" --device "$kind"
        features+=("$run/$kind.h5")
    done
    if [ -e "$PEERS/stgcn.py" ]; then
        step made-features-pytorch 120 "$PYTHON" "$PEERS/stgcn.py" features "$run/recogniser/weights-last.h5" "$run/made.h5" "$run/pytorch.h5" --frames 60
        features+=("$run/pytorch.h5")
    fi
    step agreement 60 "$PYTHON" "$here/figures.py" agreement "${features[@]}"
}

# The same networks in PyTorch, eager and compiled.
check_pytorch() {
    local precision flags how ways=(eager)
    [ -e "$PEERS/actformer_speed.py" ] || { say "no $PEERS/actformer_speed.py: PyTorch's speed is left out"; return; }
    "$PYTHON" -c 'import sys, torch; sys.exit(not hasattr(torch, "compile"))' 2>/dev/null && ways+=(compiled)
    for how in "${ways[@]}"; do
        for precision in "${precisions[@]}"; do
            flags=(--persons 2 --classes 26 --batch "$batch" --rounds "$rounds")
            [ "$precision" = float32 ] || flags+=(--bf16)
            [ "$how" = eager ] || flags+=(--compile)
            [ "$device" != cpu ] || flags+=(--cpu)
            step "pytorch-$how-$precision" 240 "$PYTHON" "$here/eager.py" "$PEERS" "${flags[@]}"
        done
    done
}

find_device() {
    device=${CUDA_DEVICE:-$("$PYTHON" -c 'import torch; print("cuda" if torch.cuda.is_available() else "cpu")' 2>/dev/null || echo cpu)}
}

check() {
    program=$BUILD/actformer
    # The paper's batches, and clips for ten steps of an epoch.
    batch=64 feature_batch=64 clips=5200 few=4 rounds=10 precisions=(float32 bf16) graphs_on=(true false)
    if [ "$device" = cpu ]; then
        batch=4 feature_batch=4 clips=208 few=1 rounds=1 precisions=(float32) graphs_on=(true) STEP=${STEP:-10}
    fi
    STEP=${STEP:-300}
    export XDG_CACHE_HOME=$WORK/cache OMP_WAIT_POLICY=passive
    code=0 kinds=(gpu cpu)
    if [ "$listing" = no ]; then
        rm -rf "$run"
        mkdir -p "$run"
        find_opencl
    fi
    if ((${#kinds[@]})); then check_program; fi
    check_pytorch
    if [ "$device" = cpu ]; then
        say "no CUDA: the tests that need it are left out"
    else
        step cuda 600 "$here/check.sh" cuda
    fi
    [ "$listing" = no ] || return 0
    say "$OUT/figures.json"
    awk -F '\t' '$2 { failed = 1 } END { exit failed }' "$logs/steps.tsv"
}

listing=no
case "${1:-}" in
    pack | unpack | build | cuda) "$1" ;;
    check | all)
        rm -rf "$logs"
        mkdir -p "$logs" "$OUT"
        find_device
        if [ "$1" = all ] && [ "$own_build" != no ]; then
            step unpack 120 "$here/check.sh" unpack
            step build 900 "$here/check.sh" build
        fi
        check
        ;;
    list)
        listing=yes
        find_device
        check
        ;;
    *)
        sed -nE '2,14s/^# ?//p' "$0" >&2
        exit 2
        ;;
esac
