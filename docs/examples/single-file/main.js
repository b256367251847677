panel.mount(document.body);
