/** Speaks sentences where the browser can. Captions show them in any case. */
export class Speaker {
  readonly #synthesis: SpeechSynthesis | null = 'speechSynthesis' in window ? window.speechSynthesis : null;

  /** Speaks a sentence in place of the one before. */
  say(sentence: string): void {
    const synthesis = this.#synthesis;
    if (!synthesis) return;
    synthesis.cancel();
    const utterance = new SpeechSynthesisUtterance(sentence);
    utterance.lang = 'en';
    synthesis.speak(utterance);
  }

  stop(): void {
    this.#synthesis?.cancel();
  }
}
