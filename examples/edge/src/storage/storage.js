/**
 * What a vehicle or a fleet needs of a runtime: bytes by key, and one alarm. A write is kept whole or not at all, and
 * stands when it returns, whatever becomes of the process.
 *
 * @typedef {object} Storage
 * @property {() => Map<string, Uint8Array>} read all that is kept
 * @property {(changes: [string, Uint8Array | null][]) => void} write null takes a key away
 * @property {() => void} clear takes all away, the alarm too
 * @property {() => number | null | Promise<number | null>} alarm when it is set for, ms
 * @property {(atMs: number) => void | Promise<void>} setAlarm
 */

/**
 * Storages by name, in one process.
 *
 * @typedef {object} Database
 * @property {(name: string) => Storage} open
 * @property {() => { name: string, atMs: number }[]} alarms all that are set
 * @property {() => void} close
 */

export {};
