// Runs in a Node worker thread.
import { parentPort, type TransferListItem } from 'node:worker_threads';
import type { Request, Setup } from './protocol.js';
import { serve } from './serve.js';

const answer = serve((reply, transfer) => parentPort?.postMessage(reply, transfer as TransferListItem[]));
parentPort?.on('message', (message: Setup | Request) => answer(message));
