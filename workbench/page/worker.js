// The same program as a worker of the page: it answers messages with what it has computed.
import init, { work } from "./gelbench_workbench.js";

const ready = init();
self.onmessage = async (message) => {
  await ready;
  const answer = work(self.name, message.data);
  if (answer) self.postMessage(answer, [answer.buffer]);
};
