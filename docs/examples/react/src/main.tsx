import { StrictMode, useState } from 'react';
import { createRoot } from 'react-dom/client';
import { Scene } from './Scene';

function App() {
  const [shown, setShown] = useState(true);
  return (
    <>
      <label>
        <input type="checkbox" checked={shown} onChange={() => setShown(!shown)} /> Show the scene
      </label>
      {shown && <Scene />}
    </>
  );
}

createRoot(document.getElementById('root') as HTMLElement).render(
  <StrictMode>
    <App />
  </StrictMode>,
);
