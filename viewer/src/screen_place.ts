import type { Camera, Vector3 } from 'three';

/** Moves an element to where a place in space is in the picture; hides it behind the camera. */
export function placeOnScreen(element: HTMLElement, at: Vector3, camera: Camera, width: number,
                              height: number): void {
  const p = at.clone().applyMatrix4(camera.matrixWorldInverse);
  element.hidden = p.z > -0.05;
  p.applyMatrix4(camera.projectionMatrix);
  const [x, y] = [(p.x + 1) / 2 * width, (1 - p.y) / 2 * height];
  element.style.transform = `translate(-50%, -50%) translate(${x}px, ${y}px)`;
}
