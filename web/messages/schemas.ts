/** Names of schemas: ROS 2 writes `package/msg/Name`, ROS 1 and what is made of it `package/Name`. */

/** A name without `/msg`, by which schemas are known here. */
export const schemaOf = (name: string): string => name.replace(/^([^/]+)\/msg\/([^/]+)$/, '$1/$2');

/** A name as it stands in data: in both forms where it has two. */
export function formsOf(schema: string): string[] {
  const [, pack, name] = /^([^/]+)\/([^/]+)$/.exec(schema) ?? [];
  return pack ? [schema, `${pack}/msg/${name}`] : [schema];
}
