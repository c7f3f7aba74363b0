// Why the server or a proxy before it refuses this page, which browsers keep to themselves. No module: browsers send
// `Origin` with those, so they are refused too.
/** A request with the socket's headers has the reason; empty: there is no server. */
window.refusal = async () => {
  try {
    const answer = await fetch('/ws', {method: 'POST', signal: AbortSignal.timeout(10000)});
    const words = answer.headers.get('Content-Type')?.startsWith('text/plain') ? (await answer.text()).trim() : '';
    return words.slice(0, 300) || `the server's answer has status ${answer.status}`;
  } catch {
    return '';
  }
};
addEventListener('error', async (event) => {
  if (event.target.tagName !== 'SCRIPT') return;
  document.querySelector('.notice').textContent = 'Cannot connect: ' + (await window.refusal() || 'there is no server: load the page again when sundog serve runs');
}, true);
