import type { Object3D, Scene } from 'three';

type Triple = readonly [number, number, number];

export interface DistantLight {
  readonly color: string;
  readonly intensity: number;
  /** The direction of the light, as a point relative to the floor below the body [m], floor frame. */
  readonly from: Triple;
}

/** The light of a real room, as a device estimates it. */
export interface EstimatedLight {
  /** The direction from which most of the light comes, floor frame; unit. */
  readonly from: Triple;
  /** The linear colour of that light times its strength; white of strength 1 is usual room light. */
  readonly key: Triple;
  /** The linear colour of the light from all sides times its strength. */
  readonly fill: Triple;
}

/** How people and things are lit. The number of lights never changes, or every material would be compiled again. */
export interface Lighting {
  /** The one light that throws shadows. */
  readonly key: DistantLight;
  readonly rim: DistantLight;
  readonly front: DistantLight;
  readonly fill: { readonly sky: string; readonly ground: string; readonly intensity: number };
  readonly shadow: {
    /** Half the side of the square that gets shadows [m]. */
    readonly halfSize: number;
    /** Texels along that side. */
    readonly resolution: number;
    /** Penumbra [texels]. */
    readonly softness: number;
    /** Its centre on the floor [m]; null: it follows the body. */
    readonly centre: { readonly x: number; readonly z: number } | null;
  };
  readonly fog: { readonly color: string; readonly near: number; readonly far: number };
  /** The reflections on shiny surfaces, built by each call; never drawn itself. */
  readonly environment: () => Scene;
  readonly environmentIntensity: number;
  /** How dark the soft disc under a body is, 0 to 1. */
  readonly contactShadow: number;
}

/** A place that people stand in. */
export interface Surroundings {
  /** Floor frame. */
  readonly object: Object3D;
  /** The children of `object` that represent the world around it. They are hidden in the user's own room. */
  readonly scenery: readonly Object3D[];
  readonly lighting: Lighting;
}

/** The place around the user; there is one at a time. */
export interface SurroundingsHost {
  readonly scene: Scene;
  /** Puts another place, with its own light and fog, where the usual one is; null brings that back. */
  setSurroundings(surroundings: Surroundings | null): void;
}
