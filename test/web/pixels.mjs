// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT

// How many pixels of two PNG pictures differ by more than rounding; the page decodes them.
export async function changed_pixels(page, one, other) {
  return page.evaluate(async ([a, b]) => {
    const pixels = async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      const context = canvas.getContext('2d');
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    };
    const [x, y] = [await pixels(a), await pixels(b)];
    let count = 0;
    for (let i = 0; i < x.length; i += 4) {
      count += Math.abs(x[i] - y[i]) + Math.abs(x[i + 1] - y[i + 1]) + Math.abs(x[i + 2] - y[i + 2]) > 24;
    }
    return count;
  }, [one.toString('base64'), other.toString('base64')]);
}
