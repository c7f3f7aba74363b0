// Statistics: rays by kind, times since the last change, and the work that it caused.
import {html, Group, useStore, short, seconds} from '../ui.js';
import {store} from '../store.js';
import {Plot} from './devices.js';

const Rows = ({rows}) => html`<table><tbody>${rows.map(([name, value]) => html`<tr><th scope="row">${name}</th><td>${value}</td></tr>`)}</tbody></table>`;

export function StatisticsPanel() {
  const status = useStore(store, (s) => s.status);
  const resolved = useStore(store, (s) => s.resolved);
  if (!status) return null;
  const {rays, times, work} = status;
  return html`
    <${Group} title="Rays" id="rays"><${Rows} rows=${[
      ['camera', short(rays.primary)], ['reflection', short(rays.reflection)], ['refraction', short(rays.refraction)], ['shadow', short(rays.shadow)],
      ['steps in fields', short(rays.march_steps)], ['all rays per second', short(status.total / Math.max(1e-3, status.seconds))]]} /></${Group}>
    <${Group} title="Since the last change" id="times"><${Rows} rows=${[
      ['scene compiled', seconds(times.compiled)], ['kernels and tables ready', seconds(times.ready)], ['first picture', seconds(times.first)],
      ['full resolution', seconds(times.full)], ['finished', seconds(times.settled)]]} /></${Group}>
    <${Group} title="What it cost" id="work"><${Rows} rows=${[
      ['search trees built', work.bvhs], ['meshes prepared', work.meshes], ['fields compiled', work.fields], ['bytes uploaded', short(work.bytes_uploaded)], ['kernels built', work.kernels_built]]} /></${Group}>
    <${Group} title="Rays per second" id="plot2"><${Plot} /></${Group}>
    ${resolved?.warnings.length > 0 && html`<${Group} title="Warnings" id="warnings"><ul class="warnings">${resolved.warnings.map((w) => html`<li>${w}</li>`)}</ul></${Group}>`}`;
}
