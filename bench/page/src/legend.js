// SPDX-License-Identifier: MIT
import { element } from "./element.js";

/** The legend of the section, of the solvers that a picture shows. */
export function legend(host, indices, names) {
  const items = host.closest("section")?.querySelectorAll(".legend > span") ?? [];
  const box = element("div", { className: "legend" });
  indices.forEach((index, i) => {
    if (!items[index]) return;
    const item = items[index].cloneNode(true);
    if (names) item.replaceChildren(item.querySelector("svg"), names[i]);
    else item.querySelector(".soft")?.remove();
    box.append(item);
  });
  return box;
}
