// What all views share: the window of time that is shown, and the instant of the cursor.

export interface View {
  /** The window of time changed. */
  window?(from_s: number, to_s: number): void;
  /** The cursor moved; NaN: it left. */
  cursor?(t_s: number): void;
}

export class State {
  from_s: number;
  to_s: number;
  cursor_s = NaN;
  private readonly views: View[] = [];
  private waiting = false;
  private moved = false;
  private zoomed = false;

  constructor(readonly first_s: number, readonly end_s: number, readonly least_s: number) {
    this.from_s = first_s;
    this.to_s = end_s;
  }

  add(view: View): void { this.views.push(view); }

  setWindow(from_s: number, to_s: number): void {
    const width = Math.min(this.end_s - this.first_s, Math.max(this.least_s, to_s - from_s));
    const middle = (from_s + to_s) / 2;
    const from = Math.max(this.first_s, Math.min(this.end_s - width, middle - width / 2));
    if (from === this.from_s && from + width === this.to_s) return;
    this.from_s = from;
    this.to_s = from + width;
    this.zoomed = true;
    this.wake();
  }

  setCursor(t_s: number): void {
    if (t_s === this.cursor_s || (Number.isNaN(t_s) && Number.isNaN(this.cursor_s))) return;
    this.cursor_s = t_s;
    this.moved = true;
    this.wake();
  }

  /** Shows an instant: the cursor on it, and a window round it. */
  jump(t_s: number, width_s: number): void {
    this.setWindow(t_s - width_s / 2, t_s + width_s / 2);
    this.setCursor(t_s);
  }

  zoom(factor: number, round_s = (this.from_s + this.to_s) / 2): void {
    this.setWindow(round_s - (round_s - this.from_s) * factor, round_s + (this.to_s - round_s) * factor);
  }
  pan(share: number): void {
    const by = share * (this.to_s - this.from_s);
    const width = this.to_s - this.from_s;
    const from = Math.max(this.first_s, Math.min(this.end_s - width, this.from_s + by));
    this.setWindow(from, from + width);
  }
  whole(): void { this.setWindow(this.first_s, this.end_s); }

  /** Views are told once a frame, however many events there were. */
  private wake(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.tell());
  }
  tell(): void {
    this.waiting = false;
    const [zoomed, moved] = [this.zoomed, this.moved];
    this.zoomed = this.moved = false;
    for (const view of this.views) {
      if (zoomed) view.window?.(this.from_s, this.to_s);
      if (moved || zoomed) view.cursor?.(this.cursor_s);
    }
  }
}
