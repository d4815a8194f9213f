// Builds elements. Every text goes in as text, never as markup.

/// An element; attributes that are false or null are left out, functions listen to the event of their name ("onclick").
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (name === "value") element.value = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/// Lets an element be seen or not. Its place is kept: what stands beside it would move under the pointer.
export function setSeen(element, isSeen) {
  element.classList.toggle("unseen", !isSeen);
}

/// A labelled select. @param options  strings, or [value, text]
export function choice(label, options, value, onchange) {
  const select = h("select", { onchange: () => onchange(select.value) },
    options.map((option) => {
      const [key, text] = Array.isArray(option) ? option : [option, option];
      return h("option", { value: key }, text);
    }));
  select.value = value;
  return h("label", { class: "choice" }, h("span", {}, label), select);
}

/// Resolves once the element has a width, which it has not before it stands in the page.
export async function laidOut(element, signal) {
  while (element.clientWidth === 0 && !signal.aborted) await new Promise(requestAnimationFrame);
}

let nextId = 0;

/// An id that no other element has.
export function freshId(stem) {
  nextId += 1;
  return `${stem}-${nextId}`;
}

/// Tells something to everyone, screen readers included.
export function notify(text, kind = "") {
  const notice = document.querySelector("#notice");
  notice.className = kind;
  notice.textContent = text;
  clearTimeout(notify.timer);
  notify.timer = setTimeout(() => { notice.textContent = ""; }, 8000);
}
