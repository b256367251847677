/**
 * What a vehicle or a fleet needs of a runtime: bytes by key, and one alarm. Writes of an object are kept in their order,
 * each whole or not at all, and stand when their promise is there, whatever becomes of the process.
 *
 * @typedef {object} Storage
 * @property {() => Map<string, Uint8Array>} read all that is kept
 * @property {(changes: Changes) => void | Promise<void>} write
 * @property {() => void | Promise<void>} clear takes all away, the alarm too
 * @property {() => number | null | Promise<number | null>} alarm when it is set for, ms
 * @property {(atMs: number) => void | Promise<void>} setAlarm
 */

/** Values by key; null takes one away. @typedef {[string, Uint8Array | null][]} Changes */

/**
 * Storages by name, in one process.
 *
 * @typedef {object} Database
 * @property {(name: string) => Storage} open
 * @property {() => { name: string, atMs: number }[]} alarms all that are set
 * @property {ReadonlyMap<string, string>} unreadable entries that cannot be read, with the reason; they are left as they are
 * @property {(name: string) => boolean} isUnreadable whether the entry of that name is one of them
 */

export {};
