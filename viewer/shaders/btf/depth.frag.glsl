#version 330 core
// A map of depths alone.
void main()
{
}
