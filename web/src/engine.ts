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

/** Asks the gridmerge that serves the page. Poses take each map's frame to a common one. Throws Error with its words. */
export async function refine(
  moving: number, pose: SE2, fixed: { map: number; T_scene_map: SE2 }[]): Promise<Refined> {
  const response = await fetch("/refine", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({
      moving, transform: pose, fixed: fixed.map(({ map, T_scene_map }) => ({ map, transform: T_scene_map })),
    }),
  });
  const answer: unknown = await response.json().catch(() => ({}));
  if (!response.ok) throw new Error((answer as { error?: string }).error ?? `gridmerge answered ${response.status}`);
  return answer as Refined;
}
