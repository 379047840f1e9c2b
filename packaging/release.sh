# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What `./dev release` does. dev reads this file: say, die, install_missing, build, use_ccache and make_venv are its own.

release_packages=(dpkg-dev lintian debootstrap python3-pil)
release_folder=build/package
example_maps=(robot_1.yaml robot_2.yaml robot_3.yaml elsewhere.yaml)

# Debian 12's sources of Ceres, by version and checksum. Debian's own library takes SuiteSparse, which is GPL in parts.
ceres_version=2.1.0+really2.1.0+dfsg-1
ceres_archive=ceres-solver_2.1.0+really2.1.0+dfsg.orig.tar.xz
ceres_sha256=acd5774187a8ea92bdf9e6d1faeb22c00bf30b1ad226ef6e2ade8b7636bbc336
ceres_options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF
  -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF -DEIGENSPARSE=ON -DSUITESPARSE=OFF -DCXSPARSE=OFF -DACCELERATESPARSE=OFF
  -DLAPACK=OFF -DCUDA=OFF -DGFLAGS=OFF -DMINIGLOG=ON -DMINIGLOG_MAX_LOG_LEVEL=-3 -DSCHUR_SPECIALIZATIONS=OFF
  -DPROVIDE_UNINSTALL_TARGET=OFF -DEXPORT_BUILD_DIR=OFF)

# debian_archive: where this machine's apt has Debian 12 from.
debian_archive() {
  local uri
  # shellcheck disable=SC2016  # apt-get puts in what these names stand for
  uri=$(apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' | awk '$1 == "bookworm" { print $2; exit }')
  [[ $uri ]] || die "release: apt knows no archive of Debian 12 (bookworm); a release is made on Debian 12"
  printf '%s\n' "$uri"
}

# fetch_ceres FOLDER
fetch_ceres() {
  local folder=$PWD/$1 uri
  uri=$(debian_archive)
  mkdir -p "$folder/lists/partial"
  printf 'deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] %s bookworm main\n' "$uri" >"$folder/sources.list"
  local apt=(apt-get -q -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$folder/lists" -o APT::Sandbox::User=root)
  "${apt[@]}" update
  (cd "$folder" && "${apt[@]}" source --download-only "ceres-solver=$ceres_version")
  (cd "$folder" && sha256sum --check <<<"$ceres_sha256  $ceres_archive") || die "release: $folder/$ceres_archive is another file than the pinned one"
}

# make_ceres: a static Ceres without SuiteSparse in build/third-party/ceres, beside its `copyright`.
make_ceres() {
  local folder=build/third-party prefix=build/third-party/ceres stamp="$ceres_sha256 ${ceres_options[*]}"
  if [[ -e $prefix/stamp && $(<"$prefix/stamp") == "$stamp" ]]; then return; fi
  say "Building Ceres without SuiteSparse (log: $folder/ceres.log)"
  rm -rf "$folder"
  mkdir -p "$folder/source"
  {
    fetch_ceres "$folder"
    tar -x -C "$folder/source" --strip-components=1 -f "$folder/$ceres_archive"
    tar -x -C "$folder/source" -f "$folder/ceres-solver_$ceres_version.debian.tar.xz" debian/copyright
    cmake -G Ninja -S "$folder/source" -B "$folder/build" -DCMAKE_INSTALL_PREFIX="$PWD/$prefix" "${ceres_options[@]}"
    cmake --build "$folder/build" --parallel "$jobs"
    cmake --install "$folder/build"
  } >"$folder/ceres.log" 2>&1 || { tail -n 40 "$folder/ceres.log"; die "release: Ceres: the above"; }
  cp "$folder/source/debian/copyright" "$prefix/copyright"
  rm -rf "$folder/source" "$folder/build"
  printf '%s' "$stamp" >"$prefix/stamp"
}

# release_sources NAME: the tree NAME in the release's folder, and packed.
release_sources() {
  local folder=$release_folder name=$1
  configure release
  cmake --build build/release --target gridmerge_page
  git archive --prefix="$name/" HEAD | tar -x -C "$folder"
  mkdir "$folder/$name/web/bundled"
  cp build/release/web/page_template.cpp "$folder/$name/web/bundled/"
  tar -C "$folder" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=go=rX,u+rw -c "$name" |
    gzip -9 -n >"$folder/$name.tar.gz"
}

# merge_example PROGRAM: the merge of the example, held against the same one in a bare system: in the folder `expected`.
merge_example() {
  local code=0 program=$PWD/$1 output=$PWD/$release_folder/expected
  (cd examples/three_robots && "$program" merge "${example_maps[@]}" --quiet -o "$output" >/dev/null) || code=$?
  ((code == 3)) || die "release: the example's merge was to leave one map out (exit code 3), but ended with exit code $code"
}

# release_debs NAME
release_debs() {
  local folder=$release_folder name=$1
  say "Building Debian packages from $folder/$name.tar.gz"
  # Folders lie to each other as those of the project's other builds do, whose compiler cache serves this one.
  local build=$folder/$name/build/release
  cmake -G Ninja -S "$folder/$name" -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DGRIDMERGE_BUILD_TESTS=OFF \
    --log-level=WARNING
  cmake --build "$build" --parallel "$jobs"
  (cd "$folder" && cpack --config "$name/build/release/CPackConfig.cmake" -B debian >cpack.log) || { cat "$folder/cpack.log"; die "cpack: the above"; }
  mv "$folder"/debian/*.deb "$folder"
  merge_example "$build/bin/gridmerge"
  rm -rf "$folder/debian" "${folder:?}/$name"
  lintian --fail-on error "$folder"/*.deb
}

# release_python NAME: an sdist of the packed sources, and of the sdist a wheel that has what it needs with it.
release_python() {
  local folder=$PWD/$release_folder name=$1 venv=$PWD/build/release-venv sources=$PWD/$release_folder/$1
  make_venv "$venv" "$(<packaging/requirements.txt)" --requirement packaging/requirements.txt
  make_ceres
  say "Making the Python sdist (output: $release_folder/python)"
  tar -x -C "$folder" -f "$folder/$name.tar.gz"
  "$venv/bin/python" -m build --sdist --no-isolation --outdir "$folder/python" "$sources" >"$folder/sdist.log" 2>&1 ||
    { tail -n 40 "$folder/sdist.log"; die "release: the sdist: the above"; }
  rm -rf "$sources"
  tar -x -C "$folder" -f "$folder/python/$name.tar.gz"
  say "Building the wheel from it (log: $release_folder/wheel.log)"
  CMAKE_PREFIX_PATH=$PWD/build/third-party/ceres CMAKE_BUILD_PARALLEL_LEVEL=$jobs "$venv/bin/pip" wheel --verbose \
    --disable-pip-version-check --no-build-isolation --no-deps --wheel-dir "$folder/plain" "$sources" >"$folder/wheel.log" 2>&1 ||
    { tail -n 40 "$folder/wheel.log"; die "release: the wheel: the above"; }
  PATH=$venv/bin:$PATH "$venv/bin/auditwheel" repair --plat auto --wheel-dir "$folder/repaired" "$folder"/plain/*.whl >>"$folder/wheel.log" 2>&1 ||
    { tail -n 40 "$folder/wheel.log"; die "release: auditwheel: the above"; }
  "$venv/bin/python" packaging/licences.py "$folder"/repaired/*.whl --build "$sources"/build/python/* --own "$sources" \
    --ceres build/third-party/ceres --ceres-version "$ceres_version" --output "$folder/python"
  rm -rf "$sources" "$folder/plain" "$folder/repaired"
  "$venv/bin/twine" check --strict "$folder"/python/*
}

# make_root SUITE: the smallest Debian of that name in build/roots/SUITE, once.
make_root() {
  local root=build/roots/$1 uri
  [[ ! -e $root/made ]] || return 0
  say "Making a bare Debian '$1' (output: $root)"
  uri=$(debian_archive)
  rm -rf "$root"
  mkdir -p build/roots/cache
  debootstrap --variant=minbase --cache-dir="$PWD/build/roots/cache" "$1" "$root" "$uri" >"build/roots/$1.log" 2>&1 ||
    { tail -n 20 "build/roots/$1.log"; die "release: debootstrap $1: the above"; }
  touch "$root/made"
}

copy_settings() {
  local root=build/roots/tried setting
  for setting in /etc/apt/apt.conf.d /etc/ssl/certs /etc/pip.conf /etc/resolv.conf /etc/hosts; do
    mkdir -p "$root/${setting%/*}"
    [[ ! -e $setting ]] || cp -rL --remove-destination "$setting" "$root/${setting%/*}/"
  done
}

# fresh_root SUITE PACKAGE...: a copy of the bare root in build/roots/tried with these packages (or files) alone, and with this
# machine's settings for apt, pip, names and certificates; the example's maps are in /maps, the release's files in /release.
fresh_root() {
  local suite=$1 root=build/roots/tried
  shift
  make_root "$suite"
  rm -rf "$root"
  cp -a "build/roots/$suite" "$root"
  copy_settings
  mkdir "$root/maps" "$root/release"
  cp examples/three_robots/*.{yaml,pgm} "$root/maps/"
  cp "$release_folder"/*.deb "$release_folder"/python/* "$root/release/"
  in_root apt-get update
  in_root sh -c "DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $*"
  copy_settings  # installing ca-certificates makes its own
}

# in_root COMMAND...: with none of this build's variables except those of proxies. Its output is shown if it fails.
in_root() {
  local output name variables=(HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
  for name in http_proxy https_proxy no_proxy; do
    [[ ! -v $name ]] || variables+=("$name=${!name}")
  done
  output=$(env -i "${variables[@]}" chroot build/roots/tried "$@" </dev/null 2>&1) || { printf '%s\n' "$output"; die "release: in a bare root, this failed: $*"; }
}

# check_merge TRANSFORMS: what a bare root has made of the example is what this build makes of it.
check_merge() {
  python3 packaging/same_merge.py "$release_folder/expected/transforms.json" "$1"
}

check_tool() {
  say "Trying the package gridmerge in a bare Debian 12"
  fresh_root bookworm '/release/gridmerge_*.deb'
  in_root sh -c "cd /maps && gridmerge merge ${example_maps[*]} -o /merged; [ \$? = 3 ]"
  check_merge build/roots/tried/merged/transforms.json
}

check_libraries() {
  local root=build/roots/tried more
  say "Trying the package libgridmerge-dev in a bare Debian 12, with no library but oneTBB"
  fresh_root bookworm '/release/libgridmerge-dev_*.deb' g++ cmake make
  # shellcheck disable=SC2016  # dpkg-query puts in what these names stand for
  more=$(chroot "$root" dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' lib{eigen3,ceres,yaml-cpp,png,fmt}-dev 2>/dev/null |
    grep '^installed' || true)
  [[ -z $more ]] || die "release: libgridmerge-dev brings more than the core takes: $more"
  cp -r tests/install/consumer "$root/consumer"
  in_root cmake -S /consumer -B /built -D COMPONENT=core
  in_root cmake --build /built
  in_root /built/consumer
}

# check_wheel SUITE: with that Debian's own Python and numpy, of which each has another version.
check_wheel() {
  local suite=$1 root=build/roots/tried
  say "Trying the wheel in a bare Debian '$suite'"
  fresh_root "$suite" python3-numpy python3-pip
  cp packaging/try_wheel.py "$root/"
  # Debian's Python, which has Debian's Pillow: another one may come first in PATH.
  /usr/bin/python3 -c 'import sys; from PIL import Image; Image.open(sys.argv[1]).save(sys.argv[2])' "$root/maps/robot_2.pgm" "$root/maps/robot_2.png"
  sed 's/robot_2\.pgm/robot_2.png/' "$root/maps/robot_2.yaml" >"$root/maps/png.yaml"
  in_root sh -c 'pip install --break-system-packages --only-binary :all: /release/*.whl'
  in_root sh -c "cd /maps && python3 /try_wheel.py ${example_maps[*]}"
  check_merge "$root/merged/transforms.json"
  chroot "$root" python3 --version
}

# check_release: everything as somebody without this machine has it. Roots need root.
check_release() {
  if ((EUID != 0)); then
    say "Not tried in bare systems: that takes root"
    return
  fi
  check_tool
  check_libraries
  check_wheel bookworm
  check_wheel trixie
  rm -rf build/roots/tried
}

# The last commit's sources, packed: nothing that is not committed is in them.
cmd_release() {
  install_missing "${build_packages[@]}" "${python_packages[@]}" "${release_packages[@]}"
  local version name folder=$release_folder
  version=$(sed -n 's/^project(gridmerge VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
  name=gridmerge-$version
  SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
  export SOURCE_DATE_EPOCH
  [[ -z $(git status --porcelain) ]] || say "There are changes that are not committed: they are left out"
  rm -rf "$folder"
  mkdir -p "$folder"
  release_sources "$name"
  release_debs "$name"
  release_python "$name"
  check_release
  rm -rf "$folder/expected"
  say "Made:"
  (cd "$folder" && sha256sum -- *.tar.gz *.deb python/*)
}
