const shown = document.querySelector('input');
const main = document.querySelector('main');

let unmount = panel.mount(main);
shown.addEventListener('change', () => {
  if (shown.checked) unmount = panel.mount(main);
  else unmount();
});
