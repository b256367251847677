/** What elements look like, in their shadow roots. */
import uplot from 'uplot/dist/uPlot.min.css?inline';
import plot from '../../plots/plot.css?inline';
import own from './element.css?inline';

let sheet: CSSStyleSheet | undefined;

/** One sheet for all elements of a page; a strict content security policy allows for it. */
export function styles(): CSSStyleSheet {
  if (!sheet) {
    sheet = new CSSStyleSheet();
    sheet.replaceSync(uplot + plot + own);
  }
  return sheet;
}
