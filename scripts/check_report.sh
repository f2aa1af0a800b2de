#!/usr/bin/env bash
# Opens a page of `fovea evaluate --html` in headless Chromium: scripts/check_report.sh PAGE [SCREENSHOT.png]
# Fails if the console has an error, a picture does not load, anything is asked of the network, or the
# slider, the buttons and the heat maps do not answer to pointer and keyboard. Skipped (exit code 0) without Chromium.
set -euo pipefail
page=$(realpath "${1:?usage: scripts/check_report.sh PAGE [SCREENSHOT.png]}")
screenshot=${2:+$(realpath -m "$2")}
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [[ -z $chromium ]]; then
  echo "skipped: no Chromium here (Debian package chromium)"
  exit 0
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
browse() {
  timeout 120 "$chromium" --headless=new --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$scratch/profile" \
    --enable-logging=stderr --host-resolver-rules="MAP * ~NOTFOUND" --virtual-time-budget=8000 "$@" 2>&1
}

# The page as it is, with a script behind it that uses it as a person would.
cat >"$scratch/test.js" <<'JS'
addEventListener("load", async function () {
  const fail = function (what) { console.error("check failed: " + what); };
  const check = function (holds, what) { if (!holds) fail(what); };
  for (const image of document.images) {
    try { await image.decode(); } catch (error) { fail("a picture does not load: " + image.alt); }
  }
  check(performance.getEntriesByType("resource").every(function (r) { return r.name.startsWith("data:"); }), "something was fetched");
  check(document.documentElement.scrollWidth <= innerWidth, "the page is wider than its window");
  const compare = document.querySelector(".view.shown .compare");
  check(compare, "no view is shown");
  const cut = function () { return parseFloat(getComputedStyle(compare).getPropertyValue("--cut")); };
  const range = compare.querySelector("input");
  range.value = 20;
  range.dispatchEvent(new Event("input"));
  check(cut() === 20, "the keyboard moves the slider");
  const box = compare.getBoundingClientRect();
  compare.setPointerCapture = function () {};  // there is no real pointer to capture
  compare.dispatchEvent(new PointerEvent("pointerdown", {clientX: box.left + 0.75 * box.width, clientY: box.top + 5, button: 0}));
  check(Math.abs(cut() - 75) < 0.5, "the pointer moves the slider");
  const visible = function (query) {
    const element = document.querySelector(".view.shown " + query);
    return element !== null && getComputedStyle(element).display !== "none";
  };
  for (const mode of ["te", "me", "slider"]) {
    document.querySelector(".modes input[value=" + mode + "]").click();
    check(visible(".heat.te") === (mode === "te"), "TE over the photograph in mode " + mode);
    check(visible(".heat.me") === (mode === "me"), "ME over the photograph in mode " + mode);
    check(visible(".drawn") === (mode === "slider"), "the map in mode " + mode);
  }
  const buttons = document.querySelectorAll(".picker button");
  buttons[buttons.length - 1].click();
  check(document.querySelectorAll(".view.shown").length === 1, "one view at a time");
  check(document.querySelectorAll(".view")[buttons.length - 1].classList.contains("shown"), "a button shows its view");
  console.log("check done");
});
JS
{ sed '$d' "$page" && echo "<script>" && cat "$scratch/test.js" && echo "</script></html>"; } >"$scratch/page.html"
for width in 1280 500; do
  log=$(browse --window-size=$width,1000 --dump-dom "file://$scratch/page.html" | grep -a 'CONSOLE' || true)
  if grep -qaiE 'check failed|error|warning|refused|failed' <<<"$log" || ! grep -qa 'check done' <<<"$log"; then
    echo "$page, $width pixels wide:" >&2
    echo "${log:-nothing on the console: the check did not run}" >&2
    exit 1
  fi
done
[[ -z $screenshot ]] || browse --window-size=1280,3000 --screenshot="$screenshot" "file://$page" >"$scratch/log"
echo "opens without an error; slider, buttons and heat maps answer"
