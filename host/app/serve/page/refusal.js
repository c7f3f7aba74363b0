// Finds out why the server, or a proxy in front of it, refuses this page, which browsers do not report. Not a module: browsers
// send `Origin` with modules, so they would be refused too.
/** The reason, from a request with the same headers as the socket's; empty: there is no server. */
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
