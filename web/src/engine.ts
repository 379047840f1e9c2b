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

/** Asks the gridmerge that serves the page. Throws Error with its words. */
export async function refine({ merge, moving, pose, fixed }: Question): Promise<Refined> {
  const response = await fetch("/refine", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({
      merge, moving, transform: pose, fixed: fixed.map(({ map, T_scene_map }) => ({ map, transform: T_scene_map })),
    }),
  });
  const answer: unknown = await response.json().catch(() => ({}));
  if (!response.ok) throw new Error((answer as { error?: string }).error ?? `gridmerge answered ${response.status}`);
  return answer as Refined;
}
