/** What is wrong with a message, so that it is left out. */
export class MessageProblem extends Error {
  readonly code: 'malformed' | 'no-field' | 'too-large';

  constructor(code: MessageProblem['code'], message: string) {
    super(message);
    this.code = code;
  }
}
