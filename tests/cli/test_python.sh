#!/bin/sh
# The Python module: its declarations are those of the headers, it installs with pip and no network,
# and does what its own tests say (python/tests). Needs Debian's python3-numpy, python3-venv and
# python3-setuptools (make deps-python).
. "$(dirname "$0")/lib.sh"
unset RELUME_LIBRARY PYTHONPATH
# The interpreter is built without sanitizers: their runtimes are loaded before it. It ends with
# much that it never frees.
sanitizers=
case $BUILD in
*asan*)
    sanitizers="$(${CC:-gcc} -print-file-name=libasan.so) $(${CC:-gcc} -print-file-name=libubsan.so)"
    export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0" PYTHONMALLOC=malloc
    ;;
*tsan*)
    skip "the Python module" "its interpreter is built without this sanitizer"
    exit 0
    ;;
esac
python=
for candidate in python3 /usr/bin/python3; do
    "$candidate" -c 'import ensurepip, numpy, setuptools, wheel' 2>/dev/null && python=$candidate && break
done
if [ -z "$python" ]; then
    skip "the Python module" "python3 with NumPy, venv and setuptools is not here (make deps-python)"
    exit 0
fi

# ---------------------------------------------------------------- declarations
cp -r "$TOP/python" package && cd package || exit 1
why="the declarations cannot be read"
if "$python" relume/_abi.py >../layout.c && "$python" relume/_abi.py layout >../here.txt &&
    why=$(${CC:-gcc} -std=c11 -Wall -Werror -I"$TOP/include" ../layout.c -o ../layout 2>&1); then
    ../layout >../there.txt
    ok "functions, constants and kinds of fields are those of the headers"
    same "structs lie as in C" ../here.txt ../there.txt
else
    not_ok "functions, constants and kinds of fields are those of the headers" "$why"
fi
# The check itself: a field that moved, a field of another kind, another function, another constant
for change in 's/float gamma; void \*response/void *response; float gamma/' \
    's/bool whole; }/int whole; }/' 's/int codes; bool shared;/bool shared; int codes;/' \
    's/relume_pack_drop(relume_pack \*pack, int view)/relume_pack_drop(relume_pack *pack)/' \
    's/"RELUME_EIO": 9/"RELUME_EIO": 8/'; do
    mkdir -p ../wrong/relume && sed "$change" relume/_abi.py >../wrong/relume/_abi.py
    if (cd ../wrong && "$python" relume/_abi.py >w.c && "$python" relume/_abi.py layout >here.txt &&
        ${CC:-gcc} -std=c11 -I"$TOP/include" w.c -o w 2>/dev/null && ./w | cmp -s - here.txt); then
        not_ok "a changed declaration is noticed" "$change"
    else
        ok "a changed declaration is noticed: $change"
    fi
done
version=$(sed -n 's/^#define RELUME_VERSION "\(.*\)"/\1/p' "$TOP/include/relume/base.h")
check "pyproject.toml has the library's version" grep -q "^version = \"$version\"" pyproject.toml
check "the module has the library's version" grep -q "^__version__ = \"$version\"" relume/__init__.py

# ---------------------------------------------------------------- installed
cd "$work" || exit 1
# The system's pip serves as well as a copy of it, which takes 8 s to install.
pip=--without-pip
"$python" -m pip --version >/dev/null 2>&1 || pip=
check "a fresh environment" "$python" -m venv --system-site-packages $pip env
check "pip installs it" env/bin/python -m pip install -q --no-build-isolation --no-index --no-cache-dir \
    --disable-pip-version-check --root-user-action=ignore ./package
mkdir elsewhere && cd elsewhere || exit 1
with() { # NAME=VALUE, arguments of the interpreter...
    setting=$1
    shift
    env LD_PRELOAD="$sanitizers" "$setting" "$work/env/bin/python" "$@"
}
in_env() { with RELUME_LIBRARY="$BUILD/librelume.so" "$@"; }
if why=$(in_env "$work/package/tests/test_relume.py" 2>&1); then
    ok "python/tests: $(echo "$why" | tail -n 3 | head -n 1)"
else
    not_ok "python/tests" "$why"
fi
case $(in_env -c 'import relume; print(relume.__file__)') in
"$work"/env/*) ok "the installed module is what was tested" ;;
*) not_ok "the installed module is what was tested" "another one was found" ;;
esac

# ---------------------------------------------------------------- where the library is
said() { # the last line of an import that fails
    "$@" -c 'import relume' 2>&1 | tail -n 1
}
case $(said with RELUME_LIBRARY=/nothing.so) in
"ImportError: librelume.so cannot be loaded; install relume, or set RELUME_LIBRARY"*/nothing.so*)
    ok "no library: says what to do" ;;
*) not_ok "no library: says what to do" "$(said with RELUME_LIBRARY=/nothing.so)" ;;
esac
module=$(dirname "$(in_env -c 'import relume; print(relume.__file__)')")
ln -s "$BUILD/librelume.so" "$module/librelume.so"
check "beside the package" with LC_ALL=C -c 'import relume'
rm "$module/librelume.so"
check "where the system looks" with LD_LIBRARY_PATH="$BUILD" -c 'import relume'

# ---------------------------------------------------------------- the page and the example
"$RELUME" synth box -o box --size 24 --lights 24 --samples 1 -q
why=$(in_env "$work/package/examples/rate_distortion.py" box plot 2>&1)
if [ "$(head -n 1 plot.csv | tr -d '\r')" = \
    "basis,coefficients,bytes,bits_per_pixel,captured_db,unseen_db" ] && [ "$(wc -l <plot.csv)" -gt 8 ]; then
    ok "examples/rate_distortion.py"
else
    not_ok "examples/rate_distortion.py" "$why"
fi
# What docs/python.md shows runs as it stands there, one block after the other.
cp -r box capture
awk '/^```python$/ { on = 1; next } /^```$/ { on = 0 } on' "$TOP/docs/python.md" >page.py
if why=$(in_env page.py 2>&1) && [ -s lit.png ]; then
    ok "docs/python.md runs"
else
    not_ok "docs/python.md runs" "$why"
fi
finish
