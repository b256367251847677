/** Moves the page's clock on, beyond what makes two changes one to Undo (web/app/state/history.ts). */
export const later = (page) =>
  page.evaluate(() => {
    const now = performance.now.bind(performance);
    performance.now = () => now() + 1000;
  });
