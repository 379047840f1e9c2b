// SPDX-License-Identifier: Apache-2.0
import type { SE2 } from "./se2";

/** What a running gridmerge says of a pose that it has climbed to from another. */
export interface Refined {
  transform: SE2;
  /** Log-likelihood ratio "same place" against "unrelated" [nats], after and before. */
  score: number;
  start_score: number;
  probability: number;
  acceptance_index: number;
  overlap: number;
  /** How far the map's walls have moved [m]. */
  moved: number;
}

/** Where the page lays a map, and others that it may fit to. Poses take each map's frame to a common one. */
export interface Question {
  /** What the page's merge is called: another one numbers its maps otherwise. */
  merge: string;
  moving: number;
  pose: SE2;
  fixed: { map: number; T_scene_map: SE2 }[];
}

/** An answer may wait for others, and takes as long as two matches. For longer nobody waits [ms]. */
const patience = 120000;

/** Asks the gridmerge that serves the page, until `asking` is aborted. Throws Error with its words, or with why there are none. */
export async function refine({ merge, moving, pose, fixed }: Question, asking: AbortController, longest = patience): Promise<Refined> {
  let isLate = false;
  const timer = setTimeout(() => {
    isLate = true;
    asking.abort();
  }, longest);
  try {
    const response = await fetch("/refine", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({
        merge, moving, transform: pose, fixed: fixed.map(({ map, T_scene_map }) => ({ map, transform: T_scene_map })),
      }),
      signal: asking.signal,
    });
    if (!response.ok) throw new Error(await refusal(response, asking.signal));
    const answer = await response.json() as Partial<Refined> | null;
    if (!isPose(answer?.transform)) throw new SyntaxError("no pose");
    return answer as Refined;
  } catch (error) {
    if (isLate) throw new Error(`gridmerge has not answered for ${longest / 1000} s`);
    // What a browser says of a server that is gone, or has ended while it answered, names no cause.
    if (error instanceof TypeError || error instanceof SyntaxError) throw new Error("gridmerge does not answer: it has ended, or cannot be reached. Start it again, and reload this page");
    throw error;
  } finally {
    clearTimeout(timer);
  }
}

/** The words of a server that refuses, or the number if it has none. */
async function refusal(response: Response, signal: AbortSignal): Promise<string> {
  const answer = await response.json().catch((error: unknown) => {
    if (signal.aborted) throw error;
    return null;
  }) as { error?: unknown } | null;
  return typeof answer?.error === "string" ? answer.error : `gridmerge answered ${response.status}`;
}

function isPose(pose: SE2 | undefined): boolean {
  return [pose?.x, pose?.y, pose?.theta].every(Number.isFinite);
}
