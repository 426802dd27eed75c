// A worker of the page: it answers messages with what it has computed.
import init, { work } from "./gelbench_workbench_worker.js";

// The library that lays pictures out asks a page how large words are. Workers have none: a canvas of their own answers.
const canvas = new OffscreenCanvas(1, 1).getContext("2d");
class Word {
  setAttribute(_, style) {
    canvas.font = `${/font-size: ([\d.]+)px/.exec(style)?.[1] ?? 12}px "DejaVu Sans", Verdana, sans-serif`;
    const size = canvas.measureText(this.textContent ?? "");
    this.offsetWidth = Math.ceil(size.width);
    this.offsetHeight = Math.ceil(size.fontBoundingBoxAscent + size.fontBoundingBoxDescent);
  }
  append() {}
  remove() {}
}
self.Window = class { static [Symbol.hasInstance](value) { return value === self; } };
self.HTMLElement = Word;
self.document = { body: new Word(), createElement: () => new Word() };

const ready = init();
self.onmessage = async (message) => {
  await ready;
  const answer = work(self.name, message.data);
  if (answer) self.postMessage(answer, [answer.buffer]);
};
