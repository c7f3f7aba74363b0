// The page's part of sundog.view(): shows pictures, and sends turns and the sliders' values.
function render({ model, el }) {
  const picture = document.createElement("img");
  const text = document.createElement("div");
  picture.width = model.get("width");
  picture.height = model.get("height");
  picture.alt = "The scene: drag to turn it, scroll to come nearer";
  picture.draggable = false;
  picture.style.cssText = "cursor: grab; touch-action: none; max-width: 100%; height: auto";
  text.style.cssText = "font-size: 0.85em; opacity: 0.7";
  el.append(picture);

  for (const [name, { least, most, value }] of Object.entries(model.get("parameters"))) {
    const label = document.createElement("label");
    const slider = document.createElement("input");
    const shown = document.createElement("output");
    Object.assign(slider, { type: "range", min: least, max: most, step: "any", value });
    label.style.cssText = "display: flex; gap: 0.6em; align-items: center";
    shown.textContent = Number(value).toPrecision(4);
    slider.addEventListener("input", () => {
      shown.textContent = Number(slider.value).toPrecision(4);
      queue({ set: { [name]: Number(slider.value) } });
    });
    label.append(name, slider, shown);
    el.append(label);
  }
  el.append(text);

  // Sends at most one message per frame; turns in between add up.
  let waiting = null;
  function queue(message) {
    if (!waiting) requestAnimationFrame(() => { model.send(waiting); waiting = null; });
    const turn = message.turn && waiting?.turn ? message.turn.map((angle, i) => angle + waiting.turn[i]) : message.turn;
    const nearer = (message.nearer ?? 1) * (waiting?.nearer ?? 1);
    const set = { ...waiting?.set, ...message.set };
    waiting = { ...waiting, ...message, set, ...(turn && { turn }), ...(nearer !== 1 && { nearer }) };
  }

  picture.addEventListener("pointerdown", (event) => picture.setPointerCapture(event.pointerId));
  picture.addEventListener("pointermove", (event) => {
    if (event.buttons & 1) queue({ turn: [-event.movementX * 0.01, event.movementY * 0.01] });
  });
  picture.addEventListener("wheel", (event) => {
    event.preventDefault();
    queue({ nearer: Math.exp(-event.deltaY * 0.001) });
  }, { passive: false });

  const show = (message, buffers) => {
    text.textContent = message.text;
    if (!buffers?.length) return;
    const url = URL.createObjectURL(new Blob([buffers[0]], { type: "image/png" }));
    picture.onload = () => URL.revokeObjectURL(url);
    picture.src = url;
  };
  model.on("msg:custom", show);
  model.send({ turn: [0, 0] });  // requests a picture, as the first may have been sent before this page existed
  return () => model.off("msg:custom", show);
}
export default { render };
