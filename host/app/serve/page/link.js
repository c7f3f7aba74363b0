// The connection to the server: calls over HTTP with the token in a header, messages and pictures over a socket whose first message is
// the token. It reconnects by itself when the server is back.
export function tokenOfAddress() {
  const found = new URLSearchParams(location.hash.slice(1)).get('token');
  try {
    if (found) sessionStorage.setItem('sundog-token', found);
    return found ?? sessionStorage.getItem('sundog-token') ?? '';
  } catch {
    return found ?? '';
  }
}

export class Link {
  token = tokenOfAddress();
  wait = 300;

  constructor(on) {
    this.on = on;
  }

  async call(path, options = {}) {
    const answer = await fetch('/api/' + path, {...options, headers: {'X-Sundog-Token': this.token}}).catch(() => {
      throw new Error('no server: start sundog serve again at this port, and open the URL that it prints in this tab');
    });
    if (answer.ok) return answer;
    throw Object.assign(new Error((await answer.text()).trim()), {status: answer.status});
  }
  async json(path) {
    return (await this.call(path)).json();
  }

  start() {
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/ws`);
    const patience = setTimeout(() => socket.close(), 10000);  // a proxy may swallow the connection
    let welcome = false;
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      clearTimeout(patience);
      socket.send(this.token);
    };
    socket.onmessage = (event) => {
      if (typeof event.data !== 'string') return this.takePicture(event.data);
      const message = JSON.parse(event.data);
      if (message.is === 'welcome') {
        welcome = true;
        this.wait = 300;
        this.on.open();
      }
      this.on.message(message);
    };
    socket.onclose = async (event) => {
      clearTimeout(patience);
      if (event.reason === 'wrong token') return this.on.closed('token');
      this.on.closed('no');
      if (!welcome) this.on.refused(await window.refusal());
      setTimeout(() => this.start(), this.wait);
      this.wait = Math.min(3000, this.wait * 1.5);
    };
  }
  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Shows a picture. `bytes`: length of the header, the header as JSON, an image file. Acknowledges it once it is on the screen. */
  async takePicture(bytes) {
    const length = new DataView(bytes).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    const blob = new Blob([new Uint8Array(bytes, 4 + length)], {type: header.settled ? 'image/png' : 'image/jpeg'});
    try {
      await this.on.picture(header, blob);
    } finally {
      if (this.socket?.readyState === WebSocket.OPEN) this.socket.send('ack');
    }
  }
}
