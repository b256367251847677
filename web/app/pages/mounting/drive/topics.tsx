/** The topics of a recording, and what each is used for. */
import type { Drive, DriveTopic } from 'boresight';

const USED: Readonly<Record<DriveTopic['usedAs'], string>> = {
  radar: 'radar',
  tracks: 'tracks of radar',
  motion: 'motion',
  mountings: 'places of radars',
  unused: 'not used',
};

export function Topics({ drive }: { drive: Drive }) {
  const { topics } = drive;
  if (topics.length === 0) return null;
  const used = topics.filter(({ usedAs }) => usedAs !== 'unused');
  return (
    <details class="topics" data-topics>
      <summary>
        {used.length} of {topics.length} {topics.length === 1 ? 'topic' : 'topics'} used
      </summary>
      <ul>
        {[...used, ...topics.filter(({ usedAs }) => usedAs === 'unused')].map((topic) => (
          <li key={`${topic.name} ${topic.messageType}`} data-topic={topic.name}>
            <span class="file">{topic.name}</span>{' '}
            <span class="muted">
              {topic.messageType || 'no type'}, {topic.messages} {topic.messages === 1 ? 'message' : 'messages'}
            </span>
            <br />
            {USED[topic.usedAs]} {topic.sensor ?? ''}
            {topic.clock === 'log-time' ? ', times of recording' : ''}
            <span class="muted">; {topic.note}</span>
          </li>
        ))}
      </ul>
    </details>
  );
}
