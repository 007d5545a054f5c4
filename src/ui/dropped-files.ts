/** Takes files dropped anywhere on the page, and shows where they may be dropped while one is dragged. */
export function acceptDroppedFiles(onFiles: (files: readonly File[]) => void): void {
  let depth = 0;
  const hover = (by: number) => {
    depth = Math.max(0, depth + by);
    document.body.classList.toggle('dragging', depth > 0);
  };
  window.addEventListener('dragenter', () => hover(1));
  window.addEventListener('dragleave', () => hover(-1));
  window.addEventListener('dragover', (event) => event.preventDefault());
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    depth = 0;
    hover(0);
    onFiles([...(event.dataTransfer?.files ?? [])]);
  });
}
