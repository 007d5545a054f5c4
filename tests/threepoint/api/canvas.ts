import { act, advance, createRoot } from '@react-three/fiber';
import { Component, createElement, type ReactElement, type ReactNode, StrictMode } from 'react';
import type { Object3D, WebGLRenderer } from 'three';
import { expect, onTestFinished, vi } from 'vitest';
import { wornHeadset } from './three-session';

/** Reports the error that a component throws, as a page's own boundary does. */
class Boundary extends Component<{ readonly report: (error: Error) => void; readonly children?: ReactNode }> {
  override state = { failed: false };
  static getDerivedStateFromError = () => ({ failed: true });
  override componentDidCatch(error: Error): void {
    this.props.report(error);
  }
  override render(): ReactNode {
    return this.state.failed ? null : this.props.children;
  }
}

/**
 * Opens a root of react-three-fiber without a browser: it draws nothing, and its frames come from `draw`. Stubs globals
 * and the page's clock, which vitest restores.
 */
export async function openCanvas() {
  vi.stubGlobal('IS_REACT_ACT_ENVIRONMENT', true);
  vi.stubGlobal('self', globalThis);
  // React reports each error that a boundary has caught.
  vi.spyOn(console, 'error').mockImplementation(() => undefined);
  const headset = wornHeadset();
  const ignore = () => undefined;
  const xr = Object.assign(headset.xr, {
    addEventListener: ignore,
    removeEventListener: ignore,
    setAnimationLoop: ignore,
  });
  const gl = { xr, render: ignore, setSize: ignore, setPixelRatio: ignore, shadowMap: {} } as unknown as WebGLRenderer;
  // The package creates a Clock, which three.js calls deprecated.
  const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
  const root = createRoot({ width: 1, height: 1 } as HTMLCanvasElement);
  await root.configure({ gl, frameloop: 'never', dpr: 1, size: { width: 1, height: 1, top: 0, left: 0 } });
  warn.mockRestore();
  onTestFinished(() => act(async () => root.unmount()));
  const errors: string[] = [];
  const report = ({ message }: Error) => errors.push(message);
  let store = root.render(null);
  return {
    headset,
    /** The messages of the errors that components have thrown. */
    errors,
    get children(): readonly Object3D[] {
      return store.getState().scene.children;
    },
    /** Renders a component; `strict`: as React's StrictMode does, which mounts everything twice. */
    async show(element: ReactElement | null, { strict = false } = {}): Promise<void> {
      // A boundary that has caught an error shows nothing: each of these starts another one where the last has failed.
      const bounded = createElement(Boundary, { key: errors.length, report }, element);
      await act(async () => {
        store = root.render(strict ? createElement(StrictMode, null, bounded) : bounded);
      });
    },
    /** Renders what has changed until a condition holds. */
    async settle(condition: () => unknown): Promise<void> {
      await vi.waitFor(
        async () => {
          await act(async () => undefined);
          expect(condition()).toBeTruthy();
        },
        { timeout: 20_000 },
      );
    },
    /** Draws frames, with the headset's where it is worn. */
    async draw(frames: number): Promise<void> {
      await act(async () => {
        for (let i = 0; i < frames; i++) {
          const frame = xr.getSession() ? headset.frame : undefined;
          advance(performance.now(), true, store.getState(), frame);
        }
      });
    },
  };
}
