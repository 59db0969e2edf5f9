// Small helpers for elements.

export const $ = (id) => document.getElementById(id);

export function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

let timer = 0;

export function say(text, good = false) {
  const place = $("message");
  place.className = good ? "good" : "";
  place.textContent = text;
  clearTimeout(timer);
  timer = setTimeout(() => { place.textContent = ""; }, 8000);
}

// What an order came to: refusals are told.
export async function told(promise, what) {
  const refused = await promise;
  if (refused) say(`${what}: ${refused}`);
  if (refused.includes("password")) $("locked").hidden = false;
  return refused;
}

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// A canvas in the pixels of the screen; null while it is not shown.
export function sized(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
  if (!width || !height) return null;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  return { context: canvas.getContext("2d"), width, height, ratio };
}
