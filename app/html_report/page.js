"use strict";
(function () {
  const root = document.documentElement;
  root.classList.add("scripted");

  // Sliders: by pointer anywhere on the picture, by keyboard through the range input.
  for (const compare of document.querySelectorAll(".compare")) {
    const range = compare.querySelector("input[type=range]");
    const set = function (share) {
      compare.style.setProperty("--cut", Math.min(100, Math.max(0, share)) + "%");
    };
    const follow = function (event) {
      const box = compare.getBoundingClientRect();
      const share = 100 * (event.clientX - box.left) / box.width;
      range.value = Math.round(share);
      set(share);
    };
    range.addEventListener("input", function () { set(Number(range.value)); });
    compare.addEventListener("pointerdown", function (event) {
      if (event.button !== 0) return;
      compare.setPointerCapture(event.pointerId);
      range.focus({preventScroll: true, focusVisible: false});
      follow(event);
      event.preventDefault();
    });
    compare.addEventListener("pointermove", function (event) {
      if (compare.hasPointerCapture(event.pointerId)) follow(event);
    });
  }

  // One view at a time.
  const buttons = Array.from(document.querySelectorAll(".picker button"));
  const views = Array.from(document.querySelectorAll(".view"));
  const show = function (index, scroll) {
    buttons.forEach(function (button, i) { button.setAttribute("aria-pressed", String(i === index)); });
    views.forEach(function (view, i) { view.classList.toggle("shown", i === index); });
    if (scroll) buttons[index].scrollIntoView({block: "nearest", inline: "nearest"});
  };
  buttons.forEach(function (button, index) {
    button.addEventListener("click", function () { show(index, true); });
    button.addEventListener("keydown", function (event) {
      const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (!step) return;
      const next = (index + step + buttons.length) % buttons.length;
      show(next, true);
      buttons[next].focus();
      event.preventDefault();
    });
  });
  if (buttons.length > 0) show(0, false);

  // What lies over the photograph.
  const stage = document.querySelector(".stage");
  for (const input of document.querySelectorAll(".modes input")) {
    const choose = function () { if (input.checked) stage.dataset.mode = input.value; };
    input.addEventListener("change", choose);
    choose();
  }

  // A frame in a chart leads to its picture.
  for (const spot of document.querySelectorAll("[data-at]")) {
    const index = buttons.findIndex(function (button) { return button.dataset.frame === spot.dataset.at; });
    if (index === -1) continue;
    spot.classList.add("can");
    spot.addEventListener("click", function () {
      show(index, true);
      document.getElementById("views").scrollIntoView({behavior: "smooth"});
    });
  }
})();
