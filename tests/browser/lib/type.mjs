/** Typing into fields as a person does: key by key, which `fill()` does not. */
import assert from 'node:assert/strict';

/** Types a text in place of what a field holds; the field must then hold it, with the focus and the caret behind it. */
export async function typeText(field, text) {
  await field.click();
  await field.press('ControlOrMeta+a');
  const { keyboard } = field.page();
  if (text === '') await keyboard.press('Backspace');
  for (const key of text) await keyboard.press(key);
  const { name, ...state } = await field.evaluate((input) => ({
    name: input.name,
    value: input.value,
    caret: input.selectionStart === input.value.length && input.selectionEnd === input.value.length,
    focused: input === document.activeElement,
  }));
  assert.deepEqual(state, { value: text, caret: true, focused: true }, `“${text}” typed into ${name}`);
}

/** Types a number, which may be empty or none. */
export const typeNumber = (field, text) => typeText(field, text);

/** Leaves a field by the keyboard. */
export const leave = (field) => field.press('Tab');

/** Moves a slider to a value by its arrow keys. */
export async function slideTo(field, value) {
  const { min, step } = await field.evaluate(({ min, step }) => ({ min: Number(min), step: Number(step) }));
  await field.press('Home');
  for (let at = min; at < value; at += step) await field.press('ArrowRight');
  assert.equal(Number(await field.inputValue()), value);
}
