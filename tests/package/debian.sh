#!/usr/bin/env bash
# Makes the Debian package, installs it into a root folder with nothing but the libraries on which it depends,
# uses it there and from another project, and removes it again.
# usage: debian.sh BUILD COMPILER GENERATOR; the package goes to BUILD/debian
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1 compiler=$2 generator=$3
work=$build/debian
root=$work/root
# xz takes eight times as long for a third less, which is worth it for packages that somebody gets: `./run package` asks for it.
compression=${GRAZE_PACKAGE_COMPRESSION-zstd}

fail() {
    echo "$*" >&2
    exit 1
}
step() { echo "== $*"; }

step "the package is made"
rm -rf "$work"
mkdir -p "$work"
cpack --config "$build/CPackConfig.cmake" -D CPACK_DEBIAN_COMPRESSION_TYPE="$compression" -B "$work"
rm -rf "$work/_CPack_Packages"
packages=("$work"/*.deb)
package=${packages[0]}
dpkg-deb --info "$package"

step "its content"
depends=$(dpkg-deb --field "$package" Depends)
[[ $depends == *libc6* && $depends == *libfmt* && $depends == *libsqlite3* && $depends == *libnlopt* && $depends == *libcholmod* ]] || fail "it depends on $depends"
dpkg-deb --fsys-tarfile "$package" | tar -tv >"$work/list"
! grep -v ' root/root ' "$work/list" || fail "files belong to somebody else"
! grep -E '^.{8}w' "$work/list" || fail "anybody may write files"
for file in bin/graze lib/libgraze.a lib/cmake/graze/graze-config.cmake include/graze/model/model.hpp \
    share/man/man1/graze.1 share/bash-completion/completions/graze share/graze/models/bouncing-ball.toml \
    share/graze/studies/mems-switch.toml share/doc/graze/README.md; do
    grep -q " ./usr/$file\$" "$work/list" || fail "/usr/$file is missing"
done
! grep -v -E ' \./(usr/.*)?$' "$work/list" || fail "there are files outside of /usr"

# dpkg needs root to change owners of files; fakeroot lets other users run it in a folder of their own.
as_root=()
if ((EUID != 0)); then
    as_root=(fakeroot)
fi

# The root gets the package status of this machine, so that dpkg checks the dependencies against it.
step "it is installed"
mkdir -p "$root"/var/lib/dpkg/{info,updates,triggers} "$root"/var/log
cp /var/lib/dpkg/status "$root/var/lib/dpkg/status"
(cd /var/lib/dpkg/info && printf '%s\0' *.list) | (cd "$root/var/lib/dpkg/info" && xargs -0 touch)
dpkg_there() { "${as_root[@]}" env PATH="$PATH:/usr/sbin:/sbin" dpkg --root="$root" --log="$work/log" "$@"; }
dpkg_there --install "$package"
[[ $(dpkg-query --admindir="$root/var/lib/dpkg" -W -f='${db:Status-Status}' graze) == installed ]] ||
    fail "it is not installed"
find "$root/usr" ! -type d | sort >"$work/installed"

step "the program runs"
"$root/usr/bin/graze" --version
if ((EUID == 0)); then
    # Only the program and its libraries are there: anything else that it needs would be missing.
    ldd "$root/usr/bin/graze" | grep -o '/[^ ]*' | while read -r library; do
        mkdir -p "$root$(dirname "$library")"
        cp -L "$library" "$root$library"
    done
    chroot "$root" /usr/bin/graze models >"$work/models"
    grep -q bouncing-ball "$work/models" || fail "there are no models"
    mkdir -p "$root/tmp"
    chroot "$root" /usr/bin/graze simulate /usr/share/graze/models/bouncing-ball.toml --time 2 --format csv \
        --output /tmp/motion.csv
    [[ -s $root/tmp/motion.csv ]] || fail "nothing was simulated"
fi

step "another project uses the library"
cp -r "$here/../../examples/project" "$work/project"
cmake -S "$work/project" -B "$work/project-build" -G "$generator" -D CMAKE_CXX_COMPILER="$compiler" \
    -D CMAKE_PREFIX_PATH="$root/usr" -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
grep -q "^graze_DIR:.*=$root/usr/" "$work/project-build/CMakeCache.txt" || fail "another graze was found"
cmake --build "$work/project-build"
"$work/project-build/impacts"

modules=("$build"/python/graze/_graze*.so)
if [[ -f $build/CPackPythonConfig.cmake && -f ${modules[0]} ]]; then
    step "the package of the Python module"
    cpack --config "$build/CPackPythonConfig.cmake" -D CPACK_DEBIAN_COMPRESSION_TYPE="$compression" -B "$work"
    rm -rf "$work/_CPack_Packages"
    module_packages=("$work"/python3-graze*.deb)
    dpkg-deb --info "${module_packages[0]}"
    depends=$(dpkg-deb --field "${module_packages[0]}" Depends)
    [[ $depends == *"python3 ("* && $depends == *python3-numpy* && $depends == *libfmt* ]] || fail "it depends on $depends"
    dpkg-deb --fsys-tarfile "${module_packages[0]}" | tar -tv >"$work/list"
    ! grep -v ' root/root ' "$work/list" || fail "files belong to somebody else"
    ! grep -v -E ' \./(usr/(lib/(python3/(dist-packages/(graze/.*)?)?)?)?)?$' "$work/list" ||
        fail "there are files outside of the module's folder"
    ! grep -E '__pycache__|\.c?pp$' "$work/list" || fail "there are left-over files"
    for file in __init__.py py.typed _graze.pyi; do
        grep -q " ./usr/lib/python3/dist-packages/graze/$file\$" "$work/list" || fail "$file is missing"
    done
    dpkg_there --install "${module_packages[0]}"
    (cd "$work" && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$root/usr/lib/python3/dist-packages /usr/bin/python3 -c "
import graze
assert graze.__file__.startswith('$root'), graze.__file__
motion = graze.simulate(graze.load('bouncing-ball'), contacts=3)
print(motion)
assert len(motion.contacts) == 3")
    dpkg_there --purge python3-graze
    [[ ! -d $root/usr/lib/python3/dist-packages/graze ]] || fail "the module's folder was left"
fi

step "it is removed"
dpkg_there --purge graze
while read -r file; do
    [[ ! -e $file ]] || fail "$file was left"
done <"$work/installed"
[[ ! -d $root/usr/share/graze && ! -d $root/usr/include/graze ]] || fail "folders were left"
rm -rf "$root" "$work/project" "$work/project-build"
step "the package is $package"
