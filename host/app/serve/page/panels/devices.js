// Devices: which of them draw, how they share the work, and their current activity.
import {html, Group, useStore, short, seconds} from '../ui.js';
import {store} from '../store.js';
import {BooleanField, ChoiceField, TextField} from '../fields.js';

function DeviceRow({device, activity}) {
  const devices = store.state.devices;
  const pick = (event) => {
    const specs = devices.filter((d) => (d.spec === device.spec ? event.target.checked : d.picked)).map((d) => d.spec);
    if (specs.length === 0) {
      event.target.checked = true;
      return store.notice('At least one device has to draw.');
    }
    store.say('devices', {specs});
  };
  return html`<li class=${'device' + (device.problem ? ' faint' : '')}>
    <label><input type="checkbox" checked=${device.picked} disabled=${!!device.problem} onChange=${pick} />
      <span><b>${device.name}</b><small>${device.spec} · ${device.platform} · ${device.type}, ${device.units} units</small></span></label>
    ${device.problem && html`<p class="error">${device.problem}</p>`}
    ${activity && html`<div class="meter"><meter min="0" max="1" value=${activity.share} aria-label="Share of the pixels"></meter><span>${Math.round(100 * activity.share)} %</span></div>
      <small>${activity.doing} · ${activity.tiles} tiles, ${short(activity.pixels)} pixels, busy ${seconds(activity.busy)}</small>
      ${activity.messages.map((m) => html`<p class="error">${m}</p>`)}`}
  </li>`;
}

/** Rays per second over the last minutes. */
export function Plot() {
  useStore(store, (s) => s.status);
  const points = store.rates;
  const top = Math.max(1, ...points.map((p) => p.rate));
  const path = points.map((p, i) => `${(300 * i) / Math.max(1, points.length - 1)},${58 - (54 * p.rate) / top}`).join(' ');
  return html`<figure class="plot"><svg viewBox="0 0 300 60" preserveAspectRatio="none" role="img" aria-label=${`Rays per second, at most ${short(top)}`}>
    <polyline points=${path} /></svg><figcaption>rays per second, at most ${short(top)}</figcaption></figure>`;
}

export function DevicesPanel() {
  const devices = useStore(store, (s) => s.devices);
  const status = useStore(store, (s) => s.status);
  const options = useStore(store, (s) => s.options);
  const activity = (spec) => status?.devices.find((d) => d.spec === spec);
  const kernels = (status?.devices ?? []).flatMap((d) => d.kernels.map((k) => ({...k, device: d.spec})));
  return html`
    <${Group} title="Devices" id="devices"><ul class="devices">${devices.map((d) => html`<${DeviceRow} key=${d.spec} device=${d} activity=${activity(d.spec)} />`)}</ul></${Group}>
    <${Group} title="How they work" id="how">
      <${TextField} label="Split" value=${options.split} help="dynamic (by measured speed), static (by estimated speed), or shares such as 3,1." onSet=${(v) => store.say('options', {split: v || 'dynamic'})} />
      <${ChoiceField} label="Work group" value=${options.work_group} choices=${['auto', 'driver', '8', '16', '32', '64', '128', '8x8', '16x4']} help="The local size of the kernels." onSet=${(v) => store.say('options', {work_group: v})} />
      <${BooleanField} label="Coarse first" value=${options.coarse} help="Large pixels come first while the picture changes. Off: always full resolution." onSet=${(v) => store.say('options', {coarse: v})} />
    </${Group}>
    <${Group} title="Rays per second" id="plot"><${Plot} /></${Group}>
    <${Group} title="Kernels of this picture" id="kernels"><table><thead><tr><th scope="col">kernel</th><th scope="col">device</th><th scope="col">launches</th><th scope="col">ms</th><th scope="col">group</th></tr></thead>
      <tbody>${kernels.map((k) => html`<tr><td>${k.name}</td><td>${k.device}</td><td>${k.launches}</td><td>${k.ms.toFixed(1)}</td><td>${k.group}</td></tr>`)}</tbody></table></${Group}>`;
}
