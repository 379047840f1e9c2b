// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { afterEach, test } from "node:test";
import { refine } from "../src/engine";
import { identity } from "../src/se2";

const question = { merge: "0123456789abcdef", moving: 1, pose: identity, fixed: [{ map: 0, T_scene_map: identity }] };
const realFetch = globalThis.fetch;
afterEach(() => void (globalThis.fetch = realFetch));

/** Answers whatever is asked so, and gives the bodies of what was asked. */
function serve(answer: (signal: AbortSignal) => Promise<Response>): unknown[] {
  const asked: unknown[] = [];
  globalThis.fetch = (_, init) => {
    asked.push(JSON.parse(init!.body as string));
    return answer(init!.signal as AbortSignal);
  };
  return asked;
}

const never = (signal: AbortSignal) =>
  new Promise<Response>((_, reject) => signal.addEventListener("abort", () => reject(signal.reason as Error)));

test("a question names the merge whose maps it numbers", async () => {
  const asked = serve(() => Promise.resolve(new Response(JSON.stringify({ moved: 0.5, transform: identity }))));
  assert.equal((await refine(question, new AbortController())).moved, 0.5);
  assert.deepEqual(asked, [{ merge: question.merge, moving: 1, transform: identity, fixed: [{ map: 0, transform: identity }] }]);
});

test("a refusal has the words of the server, or its number", async () => {
  serve(() => Promise.resolve(new Response(JSON.stringify({ error: "this page is of another merge: reload it" }), { status: 409 })));
  await assert.rejects(refine(question, new AbortController()), { message: "this page is of another merge: reload it" });
  serve(() => Promise.resolve(new Response("<html>", { status: 502 })));
  await assert.rejects(refine(question, new AbortController()), { message: "gridmerge answered 502" });
});

test("of a server that is gone it says so, in no browser's words", async () => {
  serve(() => Promise.reject(new TypeError("Failed to fetch")));
  await assert.rejects(refine(question, new AbortController()), { message: /^gridmerge does not answer: it has ended/ });
});

test("an answer that is cut short, or has no pose, is none", async () => {
  for (const body of ["{", "", "null", "{}", '{"transform": {"x": 1, "y": 2}}', '{"transform": {"x": 1, "y": null, "theta": 0}}']) {
    serve(() => Promise.resolve(new Response(body, { status: 200 })));
    await assert.rejects(refine(question, new AbortController()), { message: /^gridmerge does not answer/ }, body);
  }
});

test("nobody waits for ever", async () => {
  serve(never);
  await assert.rejects(refine(question, new AbortController(), 20), { message: "gridmerge has not answered for 0.02 s" });
  const asking = new AbortController();
  const refused = assert.rejects(refine(question, asking), { name: "AbortError" });
  asking.abort();
  await refused;
});
