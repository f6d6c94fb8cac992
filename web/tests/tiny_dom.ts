/** The part of the DOM that Preact needs to render a component in a test. */

type Listener = (this: TinyNode, event: { type: string; currentTarget: TinyNode }) => void;

export class TinyNode {
  parentNode: TinyNode | null = null;
  readonly childNodes: TinyNode[] = [];
  readonly attributes: { name: string; value: string }[] = [];
  readonly style = {};
  value = '';
  // Preact takes the names of events from the node's properties.
  readonly onfocus = null;
  readonly oninput = null;
  readonly onchange = null;
  readonly onblur = null;
  readonly onkeydown = null;
  readonly onclick = null;
  readonly oncancel = null;
  readonly onclose = null;
  /** The element that received focus last. */
  static focused: TinyNode | undefined;
  /** Of a dialog: whether it is shown. */
  open = false;
  private readonly listeners = new Map<string, Listener>();

  constructor(
    readonly nodeType: number,
    readonly localName: string,
    public data = '',
  ) {}

  get firstChild(): TinyNode | null {
    return this.childNodes[0] ?? null;
  }

  get nextSibling(): TinyNode | null {
    const siblings = this.parentNode?.childNodes ?? [];
    return siblings[siblings.indexOf(this) + 1] ?? null;
  }

  insertBefore(node: TinyNode, next: TinyNode | null): TinyNode {
    node.parentNode?.removeChild(node);
    const at = next ? this.childNodes.indexOf(next) : this.childNodes.length;
    this.childNodes.splice(at, 0, node);
    node.parentNode = this;
    return node;
  }

  removeChild(node: TinyNode): void {
    this.childNodes.splice(this.childNodes.indexOf(node), 1);
    node.parentNode = null;
  }

  setAttribute(name: string, value: string): void {
    this.removeAttribute(name);
    this.attributes.push({ name, value: String(value) });
  }

  removeAttribute(name: string): void {
    const at = this.attributes.findIndex((attribute) => attribute.name === name);
    if (at >= 0) this.attributes.splice(at, 1);
  }

  addEventListener(type: string, listener: Listener): void {
    this.listeners.set(type, listener);
  }

  removeEventListener(type: string): void {
    this.listeners.delete(type);
  }

  fire(type: string): void {
    this.listeners.get(type)?.call(this, { type, currentTarget: this });
  }

  get isConnected(): boolean {
    return this.parentNode !== null;
  }

  focus(): void {
    TinyNode.focused = this;
  }

  showModal(): void {
    this.open = true;
  }

  close(): void {
    this.open = false;
  }

  attribute(name: string): string | undefined {
    return this.attributes.find((attribute) => attribute.name === name)?.value;
  }

  /** The first element of that name at or below this node. */
  find(name: string): TinyNode | undefined {
    if (this.localName === name) return this;
    for (const child of this.childNodes) {
      const found = child.find(name);
      if (found) return found;
    }
    return undefined;
  }

  closest(name: string): TinyNode | null {
    return this.localName === name ? this : (this.parentNode?.closest(name) ?? null);
  }

  get text(): string {
    return this.data + this.childNodes.map((child) => child.text).join('');
  }
}

const element = (name: string) => new TinyNode(1, name);

/** The global `document` of a test. */
export const tinyDocument = {
  createElement: element,
  createElementNS: (_: string, name: string) => element(name),
  createTextNode: (data: string) => new TinyNode(3, '', data),
};
