# page.sh - sourced after lib.sh by tests of published pages: a browser that reads orders.txt
# (tests/tools/page.mjs) and writes said.txt.
node=$(command -v node || true)
browser=
for b in chromium chromium-browser google-chrome; do
    [ "$browser" ] || browser=$(command -v $b || true)
done

show() { # page: alone, as large as its window
    echo "open file://$work/$1"
    echo "eval (document.querySelector('relume-view').controls.node.remove(), document.querySelector('relume-view').style.cssText = 'position:fixed;inset:0;height:auto;min-height:0;z-index:9', new Promise(done => setTimeout(done, 200)))"
}
ask() { echo "eval $1" >>orders.txt; }
browse() {
    mkdir -p home
    HOME=$work/home timeout 240 node "$TOP/tests/tools/page.mjs" "$browser" "$work/home/profile" <orders.txt >said.txt 2>&1 ||
        not_ok 'the browser does as it is told' "$(grep -E '^failed' said.txt)"
    check 'pages throw nothing' sh -c '! grep "^thrown" said.txt'
}
says() { # name, pattern
    if grep -qE "$2" said.txt; then ok "$1"; else not_ok "$1" "expected /$2/, found: $(cat said.txt)"; fi
}
