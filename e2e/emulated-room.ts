import type { Page } from '@playwright/test';

/** A room for the emulated headset: its floor [m], as a hit test and plane detection find it. */
export interface EmulatedRoom {
  readonly floorHeight: number;
  readonly halfWidth: number;
  readonly ahead: number;
  readonly behind: number;
}

/** Gives the emulated headset of the page a room in place of iwer's own environment. Call it before a session. */
export const installRoom = (page: Page, room: EmulatedRoom): Promise<void> =>
  page.evaluate(({ floorHeight, halfWidth, ahead, behind }) => {
    class Room {
      readonly environmentCanvas = document.createElement('canvas');
      readonly trackedMeshes = new Set();
      readonly trackedPlanes = new Set([
        {
          // iwer reads a column-major matrix; its floor plane has the label that makes it horizontal.
          transform: { matrix: Float32Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, floorHeight, 0, 1) },
          semanticLabel: 'floor',
          polygon: [
            [-halfWidth, -ahead],
            [halfWidth, -ahead],
            [halfWidth, behind],
            [-halfWidth, behind],
          ].map(([x, z]) => new DOMPointReadOnly(x, 0, z)),
        },
      ]);
      render(): void {
        // The picture of the room lies behind that of the page, which is opaque in a window.
      }
      /** The point where a ray (its −Z) meets the floor, as a column-major matrix with +Y up. */
      computeHitTestResults(ray: ArrayLike<number>): Float32Array[] {
        const [x, y, z] = [ray[12]!, ray[13]!, ray[14]!];
        const [dx, dy, dz] = [-ray[8]!, -ray[9]!, -ray[10]!];
        if (dy >= -0.01) return [];
        const along = (floorHeight - y) / dy;
        return [Float32Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x + along * dx, floorHeight, z + along * dz, 1)];
      }
    }
    const device = window.emulatedDevice as unknown as { installSEM(room: new () => object): void };
    device.installSEM(Room);
  }, room);
