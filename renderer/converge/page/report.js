"use strict";
(() => {
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];

  // Which error the plots show.
  for (const group of all(".choice")) {
    const plots = all(".plots", group.closest("section"));
    for (const button of all("button", group)) {
      button.addEventListener("click", () => {
        for (const b of all("button", group)) b.setAttribute("aria-pressed", String(b === button));
        for (const p of plots) p.hidden = p.dataset.kind !== button.dataset.kind;
      });
    }
  }

  // The values of the nearest point.
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  tip.setAttribute("role", "status");
  document.body.append(tip);
  let near = null;
  const forget = () => {
    if (near) near.classList.remove("near");
    near = null;
    tip.hidden = true;
  };
  const show = (mark) => {
    if (mark === near) return;
    forget();
    near = mark;
    mark.classList.add("near");
    tip.textContent = mark.dataset.tip;
    tip.hidden = false;
    const at = mark.getBoundingClientRect();
    const width = tip.offsetWidth;
    const left = Math.max(6, Math.min(at.left + at.width / 2 - width / 2, innerWidth - width - 6));
    const above = at.top - tip.offsetHeight - 8;
    tip.style.left = `${left + scrollX}px`;
    tip.style.top = `${(above > 0 ? above : at.bottom + 8) + scrollY}px`;
  };
  for (const svg of all("svg.plot")) {
    const marks = all(".mark", svg);
    const find = (event) => {
      let best = null;
      let least = 40 * 40;
      for (const mark of marks) {
        const at = mark.getBoundingClientRect();
        const x = at.left + at.width / 2 - event.clientX;
        const y = at.top + at.height / 2 - event.clientY;
        if (x * x + y * y < least) [least, best] = [x * x + y * y, mark];
      }
      if (best) show(best);
      else forget();
    };
    svg.addEventListener("pointermove", find);
    svg.addEventListener("pointerdown", find);
    svg.addEventListener("pointerleave", forget);
  }

  // Two pictures, one over the other, with an edge to drag.
  for (const slider of all(".slider")) {
    const stage = slider.querySelector(".stage");
    const range = slider.querySelector("input");
    const [left, right] = all("select.run", slider);
    const what = slider.querySelector("select.what");
    const move = (share) => {
      const percent = Math.max(0, Math.min(100, 100 * share));
      stage.style.setProperty("--x", `${percent}%`);
      range.value = percent;
    };
    const put = (side, select) => {
      const option = select.selectedOptions[0];
      const source = document.getElementById(`${option.value}-${what.value}`) || document.getElementById(`${option.value}-picture`);
      stage.querySelector(`.on-${side}`).src = source.src;
      stage.querySelector(`.on-${side}`).alt = option.dataset.full;
      stage.querySelector(`.name.${side}`).textContent = option.dataset.full;
    };
    const change = () => {
      put("left", left);
      put("right", right);
    };
    const follow = (event) => {
      const box = stage.getBoundingClientRect();
      move((event.clientX - box.left) / box.width);
    };
    for (const select of [left, right, what]) select.addEventListener("change", change);
    range.addEventListener("input", () => move(range.value / 100));
    stage.addEventListener("pointerdown", (event) => {
      stage.setPointerCapture(event.pointerId);
      follow(event);
    });
    stage.addEventListener("pointermove", (event) => {
      if (stage.hasPointerCapture(event.pointerId)) follow(event);
    });
    change();
    move(0.5);
  }
})();
